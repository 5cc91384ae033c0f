#pragma once

#include "planner/model/settings.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Sets the values that a `checker:` map has, and leaves the others as they are. Faults are added
/// to the map's source.
void readCheckerKeys(const YamlMap& map, CheckerSettings& checker);

}  // namespace corridor
