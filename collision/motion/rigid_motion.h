#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

namespace corridor {

/// A placement of a rigid body: position of its reference point (metres) and orientation. Any
/// non-zero finite quaternion; motions normalise it in real arithmetic, so the stored doubles need
/// not have norm 1.
struct RigidPose {
  Vec3 p = Vec3::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// How far a real motion may stray from the nominal one and still be covered by its proof: a
/// displacement of each coordinate of the position by at most `position` (metres) and a rotation by
/// at most `rotation` (radians).
struct Tube {
  double position = 0;
  double rotation = 0;
};

/// What a moving rigid body does in a window of time [t − h, t + h], told from its middle. With x_B
/// a point of the body, y = R x_B its lever from the reference point, and |s| ≤ 1 the place in the
/// window, the point is displaced from the middle by
///   s·(linear + angular × y) + (1 − cos sα)·k × (k × y) + (sin sα − sα)·k × y,
/// α = |angular|, k the axis (Rodrigues' formula about the middle), and never by more than |linear|
/// + α·r, r the distance of y from the axis. Along a unit vector n the last two terms are below
/// (α²/2 + α³/6)·r·|n × k| (numerics: directional bounds).
struct MotionWindow {
  Transform X_WB;              ///< the pose at the middle, rounded
  Vec3 linear = Vec3::Zero();  ///< half of the window's displacement of the reference point, metres
  Vec3 angular = Vec3::Zero();  ///< half of its rotation vector, radians
  double speed = 0;             ///< |linear|, rounded up
  double angle = 0;             ///< |angular|, rounded up
  /// Rounding of all the above and the tube: every point is off by at most fixedError +
  /// reachError·|y| metres.
  double fixedError = 0;
  double reachError = 0;

  /// With `turn` = α·r: the second-order terms along a vector n are below curvature(turn)·|n ×
  /// angular|.
  double curvature(double turn) const { return turn * (0.5 + angle / 6); }
};

/// The motion of an edge (design: «What an edge is»): the reference point on a straight line at
/// constant speed, the orientation by slerp of the quaternions normalised in real arithmetic, along
/// the shorter arc; or, in the plane, the yaw linear in t the shorter way round. t in [0, 1].
class RigidMotion {
 public:
  /// @pre finite, quaternions not zero.
  static RigidMotion spatial(const RigidPose& from, const RigidPose& to, const Tube& tube);
  /// (x, y, yaw) in metres and radians, z = 0. @pre finite.
  static RigidMotion planar(const Vec3& from, const Vec3& to, const Tube& tube);

  /// The shorter way is not unique within 1e-9 rad, or within the rounding of large yaws: half
  /// turns.
  bool ambiguous() const { return ambiguous_; }
  /// No coordinate changes.
  bool still() const { return delta_.isZero(0) && angle_ == 0; }

  /// @pre 0 ≤ t − h, t + h ≤ 1, both exact.
  MotionWindow window(double t, double h) const;
  /// The rounded pose at t: that of `window(t, 0)`.
  Transform at(double t) const;

 private:
  RigidMotion() = default;
  void setRotation(const Mat3& R0, const Vec3& axis, double angle, double angleError);

  Vec3 from_ = Vec3::Zero(), delta_ = Vec3::Zero();
  Mat3 R0_ = Mat3::Identity(), KR0_ = Mat3::Zero(),
       KKR0_ = Mat3::Zero();  // Rodrigues: R(t) = R0 + sin φ·K R0 + (1 − cos φ)·K² R0
  Vec3 axis_ = Vec3::Zero();  // in the world
  double angle_ = 0;
  double fixedError_ = 0, reachError_ = 0;
  bool ambiguous_ = false;
};

}  // namespace corridor
