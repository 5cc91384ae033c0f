#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/model/model.h"
#include "planner/problem/yaml_reader.h"

/// Poses in messages of MoveIt: those of planar and floating joints, and of the robot's base.
/// Corridor does not take them over, since the problem and the robot's file say where the robot
/// is. It compares them: a proof for a robot at another place would prove nothing.
namespace corridor {

/// A pose that a message gives to a joint.
struct MessagePose {
  std::string path;  ///< for messages: "robot_state.multi_dof_joint_state: virtual_joint"
  int line = 0;
  std::string joint;  ///< a joint of the URDF, or the virtual joint of an SRDF (the robot's base)
  RigidPose pose;     ///< in metres; the quaternion is not zero
};

/// Reads the message sensor_msgs/MultiDOFJointState in `multi_dof_joint_state`. Poses without a
/// name are faults. A note names a frame other than `world`, since the poses are read as those
/// of the joints.
std::vector<MessagePose> readMessagePoses(const YamlMap& state);

/// Returns a pose as it is written in problems: "{at: [0, 0, 1], quat_xyzw: [0, 0, 0, 1]}".
std::string written(const RigidPose& pose);

/// Returns the frame that a message's `header` names, "" if there is none.
std::string frameOf(const YamlMap& message);

/// Reads a message geometry_msgs/Quaternion at a key, normalised as by `ofOrdinarySize`. Zeros, the
/// default of messages, are no rotation, with a note (MoveIt's rule). Returns nullopt if a fault
/// was added. @pre The map has the key.
std::optional<Eigen::Quaterniond> readQuaternion(const YamlMap& map, const char* key);

/// Reads a message geometry_msgs/Transform. Returns nullopt if a fault was added.
std::optional<RigidPose> readTransform(const YamlValue& value, const std::string& path,
                                       YamlSource& source);

/// Returns whether two poses are the same: the positions per axis, and the numbers of the
/// normalised quaternions (up to the sign of one quaternion), each up to `slack` or up to rounding.
/// Rounding is 2·`equalUpToRounding` (2^-49) of the largest coordinate, and of 1 for quaternions.
/// Either pose may be a product: each number is then a sum of up to four products of numbers up to
/// 1, off by at most 2^-50, and normalising adds at most 2^-51.
bool isSamePose(const RigidPose& a, const RigidPose& b, double slack = 0);

/// The difference between a pose in a message and the one in the model.
struct PoseConflict {
  std::string text;  ///< "robot_state.…: \"virtual_joint\": the base is at …, not at … as here"
  std::string fix;  ///< "give it by base in the problem"
  /// Whether the user gave the model's pose: a base, a hold in the robot's file, or the start.
  bool isChosen = false;
  /// Whether the pose is planned for, and the difference is at most `limitSlack` (`isSamePose`).
  bool isNear = false;
};

/// Compares a pose in a message with the model's: the pose in the configuration `q` for a joint
/// that is planned for, the held pose for another planar or floating joint. A name that no joint
/// has is that of the joint between the world and the robot (the virtual joint of an SRDF), whose
/// pose is the base of the only robot. Returns nullopt if the two poses are the same. A joint
/// without a pose is a conflict.
/// @param configuration the name of `q` for messages: "start".
/// @pre q is a configuration of the model.
std::optional<PoseConflict> conflictOf(const MessagePose& given, const Model& model,
                                       const Configuration& q, const std::string& configuration);

}  // namespace corridor
