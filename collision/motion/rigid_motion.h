#pragma once

#include <array>

#include <Eigen/Geometry>

#include "collision/core/transform.h"
#include "collision/motion/certify_motion.h"

namespace corridor {

/// A placement of a rigid body: position of its reference point (metres) and orientation. Any
/// non-zero finite quaternion; motions normalise it in real arithmetic, so the stored doubles need
/// not have norm 1.
struct RigidPose {
  Vec3 p = Vec3::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
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
  /// turns. Or the way of the position overflows, or the motion was made where no bound holds
  /// (core/floating_point.h).
  bool ambiguous() const { return ambiguous_ || unsound_; }
  /// No coordinate changes.
  bool still() const { return delta_.isZero(0) && angle_ == 0; }

  /// What the body does in [t − h, t + h], seen from the world: a slide, then a turn about its
  /// reference point. The tube is in the errors. The window looks at `screws`. @pre 0 ≤ t ≤ 1,
  /// h ≤ 1/2, t − h and t + h exact.
  MotionWindow window(double t, double h, std::span<ScrewTravel, 2> screws) const;
  /// The least tolerance, metres, at which rounding leaves no edge undecided whose clearance is
  /// above twice the tolerance, where no point of either body, no position and no body's coordinate
  /// is farther than `size` metres from the origin. With u = 2^-53 a clearance loses 64u·3·size to
  /// the comparison of triangles (moving_triangles.cpp), 16u·size to the position and 1024u·size to
  /// the rotation (rigid_motion.cpp), twice with what the search for a direction loses: four times
  /// 1300u·size, as 0.75 of twice the tolerance must exceed it and the tolerance.
  static double roundingTolerance(double size) { return 0x1p-53 * 5200 * size; }

  /// The rounded pose at t: that of every window about it.
  Transform at(double t) const;

 private:
  RigidMotion() = default;
  void setLine(const Vec3& from, const Vec3& to);
  void setRotation(const Mat3& R0, const Vec3& axis, double angle, double angleError);

  Vec3 from_ = Vec3::Zero(), delta_ = Vec3::Zero();
  Mat3 R0_ = Mat3::Identity(), KR0_ = Mat3::Zero(),
       KKR0_ = Mat3::Zero();       // Rodrigues: R(t) = R0 + sin φ·K R0 + (1 − cos φ)·K² R0
  Vec3 axis_ = Vec3::Zero();       // in the world
  Vec3 direction_ = Vec3::Zero();  // of delta_, unit
  double angle_ = 0;
  double fixedError_ = 0, reachError_ = 0;
  double fixedTube_ = 0, reachTube_ = 0;  // in them
  bool ambiguous_ = false, unsound_ = false;
};

/// One rigid body against the world: motion 0, and the only one.
class RigidEdge final : public MotionSource {
 public:
  explicit RigidEdge(const RigidMotion& motion) : motion_(motion) {}

  MotionWindow window(std::size_t, double t, double h) override {
    return motion_.window(t, h, screws_);
  }
  bool ambiguous() const override { return motion_.ambiguous(); }
  bool still() const override { return motion_.still(); }

 private:
  RigidMotion motion_;
  std::array<ScrewTravel, 2> screws_;
};

}  // namespace corridor
