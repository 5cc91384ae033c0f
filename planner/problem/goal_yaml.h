#pragma once

#include <vector>

#include "planner/problem/robot_file.h"

namespace corridor {

/// Reads `start` and `goal` (one state or several, and `within`) into the problem. Faults go to the
/// file's list. @pre the problem is assembled and has the bounds that its file gives.
void readStartAndGoals(const YamlMap& file, const std::vector<RobotSetup>& robots,
                       Problem& problem);

}  // namespace corridor
