#pragma once

#include <array>

#include <Eigen/Geometry>

#include "collision/core/rigid_pose.h"
#include "collision/core/transform.h"
#include "collision/motion/certify_motion.h"

namespace corridor {

/// The motion of a rigid body along an edge, t in [0, 1] (collision/PROMISES.md, "What an edge
/// is"). The reference point moves on a straight line at constant speed. The orientation follows
/// slerp of the quaternions, normalised in real arithmetic, along the shorter arc. In the plane,
/// the yaw is linear in t and goes the shorter way round.
class RigidMotion {
 public:
  /// Returns the motion in space. If a number is not finite, a quaternion is zero, or a half width
  /// of the tube is negative, the motion is `ambiguous`; so it is for `translation` and `planar`.
  static RigidMotion spatial(const RigidPose& from, const RigidPose& to, const Tube& tube);
  /// Returns the translation by `delta` metres of a body that starts at the map `from`. The
  /// position is linear in t, and the orientation does not change. @pre `from.m` is within 2^-20 of
  /// a rotation.
  static RigidMotion translation(const Transform& from, const Vec3& delta);
  /// Returns the motion in the plane z = 0, of (x, y, yaw) in metres and radians.
  static RigidMotion planar(const Vec3& from, const Vec3& to, const Tube& tube);

  /// Returns true if the edge defines no curve, or if no bound holds, for one of these reasons:
  /// * The rotation is a half turn to within 1e-9 rad, or to within the rounding of large yaws. The
  ///   shorter way is then not unique.
  /// * The displacement overflows, or a number of the motion is not finite.
  /// * The motion was made with floating-point settings under which no bound holds
  ///   (core/floating_point.h).
  bool ambiguous() const { return ambiguous_ || unsound_; }
  /// Reports whether no coordinate changes.
  bool still() const { return delta_.isZero(0) && angle_ == 0; }

  /// Returns the motion of the body as seen from the world in the time interval [t − h, t + h]: a
  /// translation, then a rotation about the reference point. The errors of the result include the
  /// tube. The result refers to `screws`, which must outlive it. @pre 0 ≤ t ≤ 1, h ≤ 1/2; t − h and
  /// t + h are exact.
  RelativeMotion relativeMotion(double t, double h, std::span<ScrewMotion, 2> screws) const;
  /// Returns a tolerance in metres that is large enough for rounding: no edge whose clearance
  /// exceeds twice this tolerance is undecided because of rounding.
  /// @pre `size`, in metres, is at least each of these norms: of the position of each body in the
  /// world, of each point of a body in the world, and of each point of a body in the body's own
  /// frame.
  ///
  /// Derivation, with u = 2^-53. Rounding reduces a clearance by 64u·3·size in the comparison of
  /// triangles (moving_triangles.cpp), by 16u·size in the position, and by 1024u·size in the
  /// rotation (rigid_motion.cpp). Together this is less than L = 1300u·size. The search for a
  /// direction may lose L once more, and finds at least 0.75 of the gap. A tolerance T suffices if
  /// 0.75·2T ≥ T + 2L, so T = 4L.
  static double roundingTolerance(double size) { return 0x1p-53 * 5200 * size; }

  /// Returns the rounded pose at t. It is the pose at the middle of every time interval about t.
  Transform at(double t) const;

 private:
  RigidMotion() = default;
  void setLine(const Vec3& from, const Vec3& to);
  /// @param lengths the length of a vector whose coordinates are the half width of the positions,
  /// divided by this half width.
  void setTube(const Tube& tube, double lengths);
  void setRotation(const Mat3& R0, const Vec3& axis, double angle, double angleError);

  Vec3 from_ = Vec3::Zero(), delta_ = Vec3::Zero();
  // Rodrigues' formula: R(t) = R0 + sin φ·K R0 + (1 − cos φ)·K² R0, with φ = t·angle_ and K x =
  // axis_ × x.
  Mat3 R0_ = Mat3::Identity(), KR0_ = Mat3::Zero(), KKR0_ = Mat3::Zero();
  Vec3 axis_ = Vec3::Zero();       // in the world
  Vec3 direction_ = Vec3::Zero();  // direction of delta_, unit length
  double angle_ = 0;
  double fixedError_ = 0, reachError_ = 0;
  double fixedTube_ = 0, reachTube_ = 0;  // the parts of these errors that the tube causes
  bool ambiguous_ = false, unsound_ = false;
};

/// One moving rigid body against the world: a source of a single motion, number 0.
class RigidEdge final : public MotionSource {
 public:
  explicit RigidEdge(const RigidMotion& motion) : motion_(motion) {}

  RelativeMotion relativeMotion(std::size_t, double t, double h) override {
    return motion_.relativeMotion(t, h, screws_);
  }
  bool ambiguous() const override { return motion_.ambiguous(); }
  bool still() const override { return motion_.still(); }

 private:
  RigidMotion motion_;
  std::array<ScrewMotion, 2> screws_;
};

}  // namespace corridor
