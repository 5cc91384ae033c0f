#pragma once

#include <vector>

#include "planner/problem/problem.h"

namespace corridor {

/// An axis-aligned box.
struct ReachBox {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};

/// For each body a box that it never leaves, whatever the configuration within the bounds; rough,
/// for telling people what is out of reach, never for verdicts. Metres, in the world.
std::vector<ReachBox> reachOf(const Problem& problem);

/// Do the boxes stay apart by more than margin and tube?
bool outOfReach(const Problem& problem, const ReachBox& a, const ReachBox& b);

}  // namespace corridor
