#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "planner/robot/note.h"
#include "planner/robot/placed_shape.h"

namespace corridor {

enum class JointType { fixed, revolute, continuous, prismatic, planar, floating };

/// The rule of a joint that mimics another one: value = multiplier·(value of `joint`) + offset. The
/// reader resolves chains of mimics, so `joint` is never a mimic.
struct Mimic {
  std::size_t joint = 0;
  double multiplier = 1, offset = 0;
};

struct JointModel {
  std::string name;
  JointType type = JointType::fixed;
  std::size_t parent = 0, child = 0;  ///< indices of links
  RigidPose X_PJ;  ///< pose of the joint's frame in the parent link's frame; at value 0 the child
                   ///< link has this pose, too
  /// In the joint's frame, not 0. For a planar joint, it is the normal of the joint's plane.
  Vec3 axis = Vec3::UnitX();
  /// Inclusive limits, rad or m. Revolute and prismatic joints only. The limits of a joint that
  /// mimics another one are not used, and may be in the wrong order.
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /// The largest speed that the URDF allows, rad/s or m/s. It is infinite if the URDF gives no
  /// speed or the speed 0. It is also infinite for planar and floating joints, because their speed
  /// is not a single number.
  double velocity = std::numeric_limits<double>::infinity();
  std::optional<Mimic> mimic;
  /// Where a file says that a planar joint can't move sideways, or "".
  std::string whyNoSliding;
  bool passive = false;  ///< by the SRDF: without a motor; planned for only if `joints` names it
  int line = 0;          ///< in the URDF file
};

struct LinkModel {
  std::string name;
  std::vector<PlacedShape> shapes;
};

/// A pair of links that is not tested, and the reason: "adjacent", "SRDF: Never", "robot.yaml:
/// allow". Pairs with a `proof` are tested in some problems.
struct AllowedPair {
  /// The margin and the range of joint values that a proof covers: for them, the pair is never in
  /// contact.
  struct Proof {
    double margin = 0;        ///< metres that the links keep apart
    double beyondLimits = 0;  ///< rad or m by which joint values may be beyond their limits
  };

  std::string a, b, reason;
  /// If set, the pair is left out only of tests that the proof covers (PairFilter, in
  /// planner/model). The proof must be for this description, with every joint at any value.
  std::optional<Proof> proof = {};
};
/// The `reason` of pairs that have a `proof`.
inline constexpr std::string_view kNeverInContact = "robot.yaml: never_in_contact";

/// A group of joints that an SRDF names.
struct JointGroup {
  std::vector<std::string> joints;   ///< in the model's order
  std::vector<std::string> missing;  ///< names of members that the URDF lacks; they are left out
  /// Names of members that are planar or floating virtual joints of the SRDF; they are left out.
  std::vector<std::string> virtualJoints;
  /// The reason why the group can't be used, such as "r.srdf:4: group … has no joint", or "".
  std::string unusable;
};

/// A named state: values of some joints, in rad and m. A planar joint has the values NAME/x, NAME/y
/// and NAME/yaw, a floating one NAME/x … NAME/qw.
struct NamedState {
  std::map<std::string, double> values;
  std::string group;     ///< the SRDF's group that the state belongs to, or ""
  std::string unusable;  ///< the reason why the state can't be used, with file and line, or ""
};

/// Returns the names of the groups or states that can be used.
template <class Named>
std::vector<std::string> usableNames(const std::map<std::string, Named>& all) {
  std::vector<std::string> names;
  for (const auto& [name, value] : all)
    if (value.unusable.empty()) names.push_back(name);
  return names;
}

/// One robot, as its robot.yaml, URDF and SRDF describe it. A rigid body is a robot of one link
/// without joints, whose `mount` is floating (SE3) or planar (SE2).
struct RobotDescription {
  std::string name;
  std::string urdfName;                ///< the name in the URDF; "" for a rigid body
  JointType mount = JointType::fixed;  ///< the joint between the robot's base and its root link
  std::size_t root = 0;
  std::vector<LinkModel> links;
  std::vector<JointModel> joints;  ///< parents come before children
  std::vector<AllowedPair> allowed;
  std::map<std::string, JointGroup> groups;  ///< of the SRDF
  std::map<std::string, NamedState> states;  ///< of the SRDF and of robot.yaml
  std::vector<Note> notes;
  /// The texts that xacro made of the URDF or SRDF, by their files. A problem's digest covers them.
  std::map<std::filesystem::path, std::string> expanded;
};

}  // namespace corridor
