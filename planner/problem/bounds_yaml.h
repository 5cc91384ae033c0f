#pragma once

#include <vector>

#include "planner/problem/robot_file.h"

namespace corridor {

/// Reads `bounds` into an assembled problem: of rigid robots' positions, of planar and floating
/// joints (which need them), and of single joints, whose limits they narrow.
void readBounds(const YamlMap& file, const std::vector<RobotSetup>& robots, Problem& problem);

/// Gives rigid robots without bounds those of the world, start and goals. @pre the problem has
/// those, and the world.
void setDefaultBounds(Problem& problem, YamlSource& source);

}  // namespace corridor
