#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `start` and `goal` (one state or several, and `within`) into the problem. Faults are added
/// to the file's list.
/// @param optional whether the keys may be absent; the problem's start or goals are then kept.
/// @pre the problem's model and the bounds of its file are set.
void readStartAndGoals(const YamlMap& file, bool optional, Problem& problem);

}  // namespace corridor
