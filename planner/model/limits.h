#pragma once

#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/robot/configuration_space.h"

namespace corridor {

struct Model;

/// A limit of the speed of a link in the world.
struct LinkSpeed {
  std::string link;       ///< for messages: "hand", "left/hand"
  std::size_t frame = 0;  ///< in Model::tree
  double speed = 0;       ///< m/s, for each of `points`
  /// The frame's origin, and the corners of a box around the link's shapes, in the frame's
  /// coordinates, m. No point of a convex hull is faster than the hull's fastest corner. So if all
  /// `points` keep the limit, every point of the link's shapes keeps it.
  std::vector<Eigen::Vector3d> points;
};

/// The limits of a motion over time, for each number of a Configuration. Limits are above 0;
/// infinity means that there is no limit.
/// - The limits of a single joint (a joint with one number) are at the index of that number: rad/s,
///   rad/s², rad/s³, or m/s and so on if it is prismatic. A joint that mimics this joint may make
///   the limits lower.
/// - The position of a planar or floating joint has limits of the lengths |ṗ|, |p̈| and |p⃛|, at the
///   first of its numbers (x); the limits of its other numbers are infinite. So a diagonal
///   motion is as fast as one along an axis.
/// - The rotation of a floating joint has limits of its angular velocity |ω| and angular
///   acceleration |ω̇|, at the first of its four numbers. The yaw of a planar joint has limits like
///   those of a single joint.
struct JointLimits {
  Configuration velocity, acceleration, jerk;
  std::vector<LinkSpeed> links;
  /// Decisions that a user of a time law may want to know, such as accelerations that are assumed.
  std::vector<std::string> notes;
};

/// Limits that a user gives. If the user does not give a limit, its member is unset.
struct LimitValues {
  std::optional<double> velocity, acceleration, jerk;
};

/// All limits that a user gives for a problem, before they are applied to its model.
struct LimitSpec {
  LimitValues joints;    ///< for each single joint without an entry in `named`
  LimitValues slides;    ///< for prismatic joints; a member that is set replaces that of
                         ///< `joints`; m/s, m/s², m/s³
  LimitValues position;  ///< for the position of each planar and floating joint; m/s, m/s², m/s³
  LimitValues rotation;  ///< for the rotation of planar and floating joints; rad/s, rad/s², rad/s³
  /// For single joints, by name ("elbow", "left/elbow"). They replace the URDF's velocity and the
  /// values above. The name may be that of a joint that mimics another one.
  std::map<std::string, LimitValues> named;
  std::map<std::string, double> links;  ///< m/s, by the name of a link ("hand", "left/hand")
  double velocityScale = 1, accelerationScale = 1;  ///< in (0, 1]; jerk is not scaled
};

/// The limit of acceleration of every joint, position and rotation for which none is given: 1
/// rad/s² or 1 m/s². URDF has no limits of acceleration, and a time law without such limits would
/// be meaningless.
inline constexpr double kAssumedAcceleration = 1;

/// Applies limits to a model. The limits of a single joint are those in `named`. For a limit that
/// is not there, let d be the limit in `joints`, or, for a prismatic joint, in `slides` if it is
/// set there: the limit of velocity is the smaller one of d and the URDF's velocity, and the limit
/// of acceleration or jerk is d. Positions and rotations have the limits in `position` and
/// `rotation`. If nothing gives the acceleration, its limit is kAssumedAcceleration, and a note
/// says so. A note also says if a velocity in `named` is above the URDF's. If `named` has a limit L
/// for a mimicking joint, the joint's leader gets the limit L/|multiplier|, unless the leader's own
/// limit is lower. A mimicking joint that is not in `named` limits nothing. Finally, velocities and
/// accelerations are multiplied by the scales of `spec`, except link speeds.
/// @pre All names in `spec` are names of the model's joints (`jointsWithLimits`) and links.
JointLimits limitsOf(const Model& model, const LimitSpec& spec = {});

/// A joint for which limits can be given by name.
struct LimitedJoint {
  std::string name;        ///< "elbow", "left/elbow"
  std::string plain;       ///< the URDF's name: "elbow"
  std::size_t number = 0;  ///< index, in a Configuration, of the number that moves the joint
  double multiplier = 1;   ///< that of a mimic; for other joints 1
  bool isMimic = false;
  bool isPrismatic = false;
  double velocity = 0;  ///< the URDF's limit, rad/s or m/s; infinite if the URDF gives none
};
/// Returns the single joints that move with a planned coordinate: the planned joints, and the
/// joints that mimic them with a multiplier other than 0.
std::vector<LimitedJoint> jointsWithLimits(const Model& model);

}  // namespace corridor
