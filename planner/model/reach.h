#pragma once

#include <vector>

#include "planner/model/model.h"
#include "planner/model/task.h"

namespace corridor {

/// An axis-aligned box.
struct ReachBox {
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
};

/// Returns for each body a box that contains it in every configuration within the bounds; metres,
/// in the world. The boxes are rough and not proved: they are for display only, never for verdicts.
std::vector<ReachBox> reachOf(const Model& model);

/// Returns whether, according to these boxes, two bodies are always farther apart than the sum of
/// the margin, the largest padding, and the displacement that the tube allows.
bool outOfReach(const Task& task, const ReachBox& a, const ReachBox& b);

}  // namespace corridor
