#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Sets what a `checker:` map says, and leaves the rest as it is. Faults go to the map's source.
void readCheckerKeys(const YamlMap& map, Problem::CheckerSpec& checker);

}  // namespace corridor
