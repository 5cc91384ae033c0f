#pragma once

#include <string>
#include <vector>

#include "planner/model/model.h"

/// Functions that choose the joints of a robot that are planned for.
namespace corridor {

/// Returns whether a joint can be planned for, that is, whether it is neither fixed nor a mimic,
/// and its lower limit differs from its upper limit.
bool canMove(const JointModel& joint);

/// Returns all joints that can move, except those that are held already or passive.
std::vector<std::size_t> allMoving(const ModelRobot& robot);

/// Returns the complaint about a robot for which `allMoving` returns no joint: "has no joint that
/// can be planned for", followed by the reason or by what to do.
std::string whyNoneMoves(const ModelRobot& robot);

/// Returns a list of the held joints and their values, such as "finger 0.02, base not moved".
/// Joints in `heldByFile` are left out. The list may be empty.
std::string heldText(const ModelRobot& robot);

/// Sets the joints that are planned for. Other joints without a value in `held` or `heldPoses` get
/// one: the value nearest to 0 within their limits, or the identity for planar and floating joints.
void chooseJoints(ModelRobot& robot, const std::vector<std::size_t>& active);

}  // namespace corridor
