#pragma once

#include <vector>

#include "planner/problem/robot_file.h"

namespace corridor {

/// Reads `start` and `goal` (a state, or several; and `within`) into an assembled problem whose
/// explicit bounds are set. Faults go to the file's list.
void readStartAndGoals(const YamlMap& file, const std::vector<RobotSetup>& robots,
                       Problem& problem);

}  // namespace corridor
