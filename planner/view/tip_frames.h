#pragma once

#include <vector>

#include "planner/model/model.h"

namespace corridor::view {

/// Returns the tip frame of each robot that moves. The tip is the frame with a body that has the
/// most moving joints between it and the robot's base; if several frames have equally many, it is
/// the last of them. A rigid body's tip is its own frame; an arm's tip is usually its hand. Joints
/// that mimic a planned joint count as moving, held joints do not.
std::vector<std::size_t> tipFrames(const Model& model);

}  // namespace corridor::view
