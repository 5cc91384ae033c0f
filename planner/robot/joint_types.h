#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/robot/robot_model.h"

namespace corridor {

/// Joint types by the names that URDF gives them; nullopt for an unknown name.
std::string nameOf(JointType type);
std::optional<JointType> jointType(std::string_view name);
std::vector<std::string> jointTypeNames();

/// Returns whether the joint is planar or floating: it then has a pose, not a single value.
bool isWhole(JointType type);
/// Returns whether the joint has a value of its own: it is neither fixed nor a mimic.
bool movesItself(const JointModel& joint);

/// Returns the index of the joint with this name.
std::optional<std::size_t> findJoint(const RobotModel& model, std::string_view name);

}  // namespace corridor
