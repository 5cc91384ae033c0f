#pragma once

#include <vector>

#include "planner/problem/problem.h"

namespace corridor {

/// Returns notes on lengths that are probably in another unit than metres: if no obstacle is within
/// reach of a robot, and for each obstacle that is far larger than the robots, or far away. If
/// there are polygons, also on bodies that do not reach their plane.
std::vector<Note> notesOnReach(const Problem& problem);

}  // namespace corridor
