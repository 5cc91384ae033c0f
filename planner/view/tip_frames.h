#pragma once

#include <vector>

#include "planner/model/model.h"

namespace corridor::view {

/// Returns the tip frame of each robot that moves. Among the frames to which bodies of the robot
/// are fixed, the tip is the frame with the most moving joints between it and the robot's base. If
/// several frames have equally many, the tip is the last of them. A rigid body's tip is its own
/// frame; an arm's tip is usually its hand. Joints that mimic a planned joint count as moving, held
/// joints do not.
std::vector<std::size_t> tipFrames(const Model& model);

}  // namespace corridor::view
