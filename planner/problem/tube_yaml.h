#pragma once

#include "planner/model/task.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads the `tube` of a problem.
/// @param known whether `space` is complete; otherwise the robots have faults, and keys that depend
/// on the robots are not checked.
TubeSpec readTube(const YamlMap& file, const ConfigurationSpace& space, bool known);

}  // namespace corridor
