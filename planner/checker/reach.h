#pragma once

#include <vector>

#include "planner/model/model.h"
#include "planner/model/task.h"

namespace corridor {

/// An axis-aligned box.
struct ReachBox {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};

/// Returns for each body a box that it never leaves in any configuration within the bounds. Metres,
/// in the world. The boxes are rough and not proved: for display only, never for verdicts.
std::vector<ReachBox> reachOf(const Model& model);

/// Returns whether two bodies in these boxes keep more than margin and tube from each other.
bool outOfReach(const Task& task, const ReachBox& a, const ReachBox& b);

}  // namespace corridor
