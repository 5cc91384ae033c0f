#pragma once

#include "planner/model/task.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads the key `tube` of a problem.
/// @param isComplete whether `space` has the joints of all robots. It is false if robots have
/// faults; keys that depend on the robots are then not checked.
TubeSpec readTube(const YamlMap& file, const ConfigurationSpace& space, bool isComplete);

}  // namespace corridor
