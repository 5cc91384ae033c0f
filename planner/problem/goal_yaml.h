#pragma once

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads `start` and `goal` (one state or several, and `within`) into the problem. Faults are added
/// to the file's list. @pre the problem has its model, and the bounds that its file gives.
/// @param optional the keys may be absent; what the problem has is then kept.
void readStartAndGoals(const YamlMap& file, bool optional, Problem& problem);

}  // namespace corridor
