#include "planner/verify/edge_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace corridor::verify {
namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;
constexpr Real kAmbiguous = 1e-9L;      // radians; design: «What an edge is»
constexpr Real kUp = 1 + 0x1p-50L;      // more than any sum here rounds, relatively
constexpr Real kAngleError = 0x1p-57L;  // 128u: twice that of omega_

}  // namespace

EdgeCurve::EdgeCurve(const PathState& from, const PathState& to, bool planar) : planar_(planar) {
  if (planar) {
    from_ = {from.xyYaw.x(), from.xyYaw.y(), 0};
    way_ = RealVec(to.xyYaw.x(), to.xyYaw.y(), 0) - from_;
    yaw_ = from.xyYaw.z();
    turn_ = std::remainder(Real(to.xyYaw.z()) - yaw_, 2 * kPi);
    angle_ = std::abs(turn_) * kUp;
    ambiguous_ = kPi - std::abs(turn_) <= kAmbiguous;
  } else {
    from_ = from.pose.p.cast<Real>();
    way_ = to.pose.p.cast<Real>() - from_;
    q0_ = from.pose.q.coeffs().cast<Real>().normalized();
    q1_ = to.pose.q.coeffs().cast<Real>().normalized();
    if (q0_.dot(q1_) < 0) q1_ = -q1_;
    omega_ = 2 * std::atan2((q1_ - q0_).norm(), (q1_ + q0_).norm());
    angle_ = omega_ == 0 ? 0 : (2 * omega_ + kAngleError) * kUp;
    ambiguous_ = kPi - 2 * omega_ <= kAmbiguous;
  }
  length_ = way_.norm() * kUp;
}

EdgeCurve::At EdgeCurve::at(Real t) const {
  At result;
  Placement& placement = result.placement;
  placement.position = from_ + t * way_;
  if (planar_) {
    const Real yaw = yaw_ + t * turn_, c = std::cos(yaw), s = std::sin(yaw);
    placement.rotation << c, -s, 0, s, c, 0, 0, 0, 1;
    result.yaw = static_cast<double>(yaw);
    result.pose.q = Eigen::Quaterniond(static_cast<double>(std::cos(yaw / 2)), 0, 0,
                                       static_cast<double>(std::sin(yaw / 2)));
  } else {
    const Real sine = std::sin(omega_);
    const Real w0 = sine > 0 ? std::sin((1 - t) * omega_) / sine : 1 - t;
    const Real w1 = sine > 0 ? std::sin(t * omega_) / sine : t;
    const Quaternion q = w0 * q0_ + w1 * q1_;
    const Real x = q[0], y = q[1], z = q[2], w = q[3], k = 2 / q.squaredNorm();
    placement.rotation << 1 - k * (y * y + z * z), k * (x * y - w * z), k * (x * z + w * y),
        k * (x * y + w * z), 1 - k * (x * x + z * z), k * (y * z - w * x), k * (x * z - w * y),
        k * (y * z + w * x), 1 - k * (x * x + y * y);
    result.pose.q.coeffs() = q.cast<double>();
  }
  result.pose.p = placement.position.cast<double>();
  return result;
}

Real EdgeCurve::travel(Real dt, Real reach) const {
  return (length_ * dt + std::min(angle_ * dt, Real(2)) * reach) * kUp;
}

Real EdgeCurve::size(Real reach) const {
  // 8u of the largest yaw, in units of 2^-50 = 2^14 u, is 2^-11 of it.
  const Real yaws = planar_ ? 1 + 0x1p-11L * (std::abs(yaw_) + std::abs(turn_)) : 1;
  return (from_.norm() + (from_ + way_).norm() + way_.norm() + yaws * reach) * kUp;
}

}  // namespace corridor::verify
