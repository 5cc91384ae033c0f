#pragma once

#include <vector>

#include "planner/model/model.h"

namespace corridor::view {

/// Returns for each robot its tip: the frame with a body that has the most moving joints before it,
/// and the last one of several. It is a rigid body's own frame, or an arm's hand. Held joints don't
/// move; joints that mimic a planned one do. Robots that stand still are left out.
std::vector<std::size_t> tipFrames(const Model& model);

}  // namespace corridor::view
