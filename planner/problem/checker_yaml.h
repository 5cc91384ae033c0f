#pragma once

#include "planner/model/settings.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Sets the members of `checker` whose keys are in `map`, the value of the key `checker`. The other
/// members do not change. Faults are added to the map's source.
void readCheckerKeys(const YamlMap& map, CheckerSettings& checker);

}  // namespace corridor
