#pragma once

#include <vector>

#include "planner/problem/problem.h"

namespace corridor {

/// Returns notes on lengths that are probably not in metres: one note if no robot can reach any
/// obstacle, and one for each obstacle (at most 100) that is far larger than the robots, or far
/// away. If there are polygons, there is also a note for each body that does not reach the plane of
/// the polygons.
std::vector<Note> notesOnReach(const Problem& problem);

}  // namespace corridor
