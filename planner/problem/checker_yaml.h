#pragma once

#include "planner/model/settings.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Sets the members of `checker` whose keys are in a `checker:` map, and leaves the other members
/// as they are. Faults are added to the map's source.
void readCheckerKeys(const YamlMap& map, CheckerSettings& checker);

}  // namespace corridor
