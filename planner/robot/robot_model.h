#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/robot/placed_shape.h"

namespace corridor {

enum class JointType { fixed, revolute, continuous, prismatic, planar, floating };

/// The rule of a joint that mimics another one: value = multiplier·(value of `joint`) + offset. The
/// reader resolves chains of mimics, so `joint` itself is no mimic.
struct Mimic {
  std::size_t joint = 0;
  double multiplier = 1, offset = 0;
};

struct JointModel {
  std::string name;
  JointType type = JointType::fixed;
  std::size_t parent = 0, child = 0;  ///< indices of links
  RigidPose X_PJ;  ///< pose of the joint's frame in the parent link's frame; at value 0 the child
                   ///< link has the same pose
  Vec3 axis = Vec3::UnitX();  ///< in the joint's frame, not 0; a planar joint's normal
  /// Inclusive limits, rad or m. Revolute and prismatic joints only.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  std::optional<Mimic> mimic;
  int line = 0;  ///< in the URDF file
};

struct LinkModel {
  std::string name;
  std::vector<PlacedShape> shapes;
};

/// A pair of links that is never tested, and the reason: "adjacent", "SRDF: Never", "robot.yaml:
/// allow".
struct AllowedPair {
  std::string a, b, reason;
};

/// One robot, as its robot.yaml, URDF and SRDF describe it. A rigid body is a robot of one link
/// without joints, whose `mount` is floating (SE3) or planar (SE2).
struct RobotModel {
  std::string name;
  JointType mount = JointType::fixed;  ///< the joint between the robot's base and its root link
  std::size_t root = 0;
  std::vector<LinkModel> links;
  std::vector<JointModel> joints;  ///< parents come before children
  std::vector<AllowedPair> allowed;
  std::map<std::string, std::vector<std::string>> groups;  ///< SRDF groups: their joints' names
  std::map<std::string, std::map<std::string, double>> states;  ///< named states: joint values
  std::map<std::string, std::string> stateGroup;                ///< SRDF: the group of each state
  /// SRDF groups from which members are left out: names that the URDF lacks, the first 31.
  std::map<std::string, std::vector<std::string>> missingMembers;
  /// SRDF groups and states that can't be made, with the reasons: "r.srdf:4: it has no joint …".
  struct {
    std::map<std::string, std::string> groups, states;
  } unusable;
  std::vector<std::string> notes;
};

}  // namespace corridor
