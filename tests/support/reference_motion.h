#pragma once

#include <array>
#include <cmath>

#include "collision/motion/rigid_motion.h"

namespace corridor::test {

/// A second implementation of the motion of a rigid body along an edge, in long double. Its formula
/// differs from that of the code under test: slerp as a sum of the two quaternions, weighted by
/// sines.
class ReferenceMotion {
 public:
  using Vec3L = Eigen::Matrix<long double, 3, 1>;
  using Mat3L = Eigen::Matrix<long double, 3, 3>;
  using Vec4L = Eigen::Matrix<long double, 4, 1>;

  ReferenceMotion(const RigidPose& from, const RigidPose& to)
      : p0_(from.p.cast<long double>()),
        p1_(to.p.cast<long double>()),
        q0_(normalised(from.q)),
        q1_(normalised(to.q)) {
    if (q0_.dot(q1_) < 0) q1_ = -q1_;
    angle_ = 2 * std::atan2((q1_ - q0_).norm(), (q1_ + q0_).norm());  // between the quaternions
  }

  Vec3L position(long double t) const { return p0_ + t * (p1_ - p0_); }
  Mat3L rotation(long double t) const {
    const long double s = std::sin(angle_);
    const long double a = angle_ < 1e-12L ? 1 - t : std::sin((1 - t) * angle_) / s;
    const long double b = angle_ < 1e-12L ? t : std::sin(t * angle_) / s;
    const Vec4L q = (a * q0_ + b * q1_).normalized();
    return Eigen::Quaternion<long double>(q).toRotationMatrix();
  }
  Vec3L point(long double t, const Vec3& p_B) const {
    return position(t) + rotation(t) * p_B.cast<long double>();
  }

 private:
  static Vec4L normalised(const Eigen::Quaterniond& q) {
    return q.coeffs().cast<long double>().normalized();
  }
  Vec3L p0_, p1_;
  Vec4L q0_, q1_;
  long double angle_;
};

}  // namespace corridor::test
