#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `start` and `goal` (one state or several, and `within`) into the problem. Faults are added
/// to the file's list.
/// @param optional whether `start` and `goal` may be absent. If one is absent, the problem's start
/// or goals do not change.
/// @pre The problem's model is set, with the bounds that the problem's file gives.
void readStartAndGoals(const YamlMap& file, bool optional, Problem& problem);

}  // namespace corridor
