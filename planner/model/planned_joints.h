#pragma once

#include <vector>

#include "planner/model/model.h"

/// Which joints of a robot are planned for.
namespace corridor {

/// Returns whether the joint has a value of its own, and its limits leave it more than one.
bool canMove(const JointModel& joint);

/// Returns all joints that can move, except those that are held already.
std::vector<std::size_t> allMoving(const ModelRobot& robot);

/// Sets the joints that are planned for. Other joints without a value in `held` or `heldPoses` are
/// held at the value nearest to 0 within their limits, planar and floating ones at the identity,
/// with a note in `robot.model.notes`.
void chooseJoints(ModelRobot& robot, const std::vector<std::size_t>& active);

}  // namespace corridor
