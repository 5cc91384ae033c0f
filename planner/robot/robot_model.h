#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/robot/placed_shape.h"

namespace corridor {

enum class JointType { fixed, revolute, continuous, prismatic, planar, floating };

/// Follows another joint: value = multiplier·(value of `joint`) + offset. Chains of mimics are
/// resolved by the reader: `joint` doesn't mimic itself.
struct Mimic {
  std::size_t joint = 0;
  double multiplier = 1, offset = 0;
};

struct JointModel {
  std::string name;
  JointType type = JointType::fixed;
  std::size_t parent = 0, child = 0;  ///< links, by index
  RigidPose X_PJ;  ///< of the joint's frame, and of the child's at value 0, in the parent link's
  Vec3 axis = Vec3::UnitX();  ///< in the joint's frame, not 0; a planar joint's normal
  /// Inclusive; rad or m. Revolute and prismatic joints only.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::optional<Mimic> mimic;
  int line = 0;  ///< in the URDF
};

struct LinkModel {
  std::string name;
  std::vector<PlacedShape> shapes;
};

/// A pair of links that is not tested, and why: "adjacent", "SRDF: Never", "robot.yaml: allow".
struct AllowedPair {
  std::string a, b, reason;
};

/// What robot.yaml, URDF and SRDF say of one robot. A rigid body is a robot of one link and no
/// joints whose `mount` is floating (SE3) or planar (SE2).
struct RobotModel {
  std::string name;
  JointType mount = JointType::fixed;  ///< how the root link stands on the robot's base
  std::size_t root = 0;
  std::vector<LinkModel> links;
  std::vector<JointModel> joints;  ///< parents before children
  std::vector<AllowedPair> allowed;
  std::map<std::string, std::vector<std::string>> groups;       ///< SRDF: joint names
  std::map<std::string, std::map<std::string, double>> states;  ///< named; joint values
  std::map<std::string, std::string> stateGroup;                ///< SRDF: which group a state is of
  std::vector<std::string> notes;
};

}  // namespace corridor
