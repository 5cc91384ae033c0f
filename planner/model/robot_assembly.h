#pragma once

#include <vector>

#include "planner/model/model.h"

namespace corridor {

/// Moves a robot into the model: adds its frames, its coordinates and its bodies. The shapes of the
/// robot's links are moved into the bodies. Planar and floating joints, and a rigid robot, get
/// groups of coordinates. The coordinates of their positions get the bounds NaN, which mean "not
/// set yet".
/// @returns the coordinates of the robot's single joints, which are in no group yet.
std::vector<std::size_t> assembleRobot(ModelRobot robot, Model& model);

/// Returns the pose of a joint's child link in the frame of the joint. @pre the joint is planar or
/// floating. @param state the joint's state; that of a planar joint is a pose in the plane normal
/// to its axis, whose frame is the joint's, turned by the smallest rotation from z to the axis
RigidPose poseInJointFrame(const JointModel& joint, const RigidPose& state);

}  // namespace corridor
