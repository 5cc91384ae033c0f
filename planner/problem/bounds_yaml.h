#pragma once

#include <vector>

#include "planner/problem/robot_file.h"

namespace corridor {

/// Reads `bounds` into an assembled problem. They bound the positions of rigid robots and of planar
/// and floating joints, and narrow the limits of single joints. Planar and floating joints need
/// them; rigid robots without bounds get theirs by `setDefaultBounds`. Faults go to the file's
/// list.
void readBounds(const YamlMap& file, const std::vector<RobotSetup>& robots, Problem& problem);

/// Gives rigid robots without bounds the bounding box of the world, enlarged to contain start and
/// goals. Adds a fault if the problem has no obstacles, or if the box is flat. @pre the problem has
/// its obstacles, start and goals.
void setDefaultBounds(Problem& problem, YamlSource& source);

}  // namespace corridor
