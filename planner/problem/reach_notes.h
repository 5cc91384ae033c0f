#pragma once

#include <vector>

#include "planner/problem/problem.h"

namespace corridor {

/// Returns notes on lengths that are probably in another unit than metres: one note if no robot can
/// reach any obstacle, and one for each obstacle that is far larger than the robots, or far away.
/// If there are polygons, the notes also name bodies that do not reach the plane of the polygons.
std::vector<Note> notesOnReach(const Problem& problem);

}  // namespace corridor
