#pragma once

#include <vector>

#include "planner/model/model.h"

namespace corridor::view {

/// Returns each robot's tip: among the frames with a body, the one with the most moving joints
/// before it; if several have equally many, the last of these. A rigid body's tip is its own frame;
/// an arm's tip is its hand. Held joints don't move; joints that mimic a planned one do. Robots
/// that stand still are left out.
std::vector<std::size_t> tipFrames(const Model& model);

}  // namespace corridor::view
