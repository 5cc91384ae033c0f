#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/robot/robot_description.h"

namespace corridor {

/// Stands in place of the index of a link, joint or group if there is no such index.
inline constexpr std::size_t kNoIndex = SIZE_MAX;

/// Convert between joint types and their names in URDF: `nameOf` returns the name of a type,
/// `jointType` the type of a name, or nullopt for an unknown name. `jointTypeNames` returns all
/// names.
std::string nameOf(JointType type);
std::optional<JointType> jointType(std::string_view name);
std::vector<std::string> jointTypeNames();

/// Returns whether joints of this type are planar or floating. Such a joint has a pose in place of
/// a single value.
bool isPoseJoint(JointType type);
/// Returns whether the joint has a value or pose of its own, that is, whether it is not fixed and
/// mimics no other joint.
bool hasOwnValue(const JointModel& joint);

/// Returns the index of the joint with this name, or nullopt if the model has no such joint.
std::optional<std::size_t> findJoint(const RobotDescription& model, std::string_view name);

}  // namespace corridor
