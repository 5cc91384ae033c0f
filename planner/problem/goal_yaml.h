#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `start` and `goal` (one state or several, and `within`) into the problem. Faults are added
/// to the file's list. @pre the problem's model is set, and so are the bounds that its file gives.
/// @param optional if true, the keys may be absent; the problem's start or goals are then kept.
void readStartAndGoals(const YamlMap& file, bool optional, Problem& problem);

}  // namespace corridor
