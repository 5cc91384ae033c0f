#include "collision/motion/rigid_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/core/circle.h"
#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"

namespace corridor {
namespace {

/// Bound of the error of the computed rotation, and of half of the interval's rotation vector, as
/// an operator norm: metres of displacement per metre of lever. The terms, with u the unit
/// roundoff:
/// * normalising a quaternion: the norm (sum of squares, root) and the quotient are off by less
///   than 5u, relatively, so |q̂ − q| < 6u;
/// * the relative quaternion: 2·6u from its factors, 2·4u from four products per component: < 20u;
/// * the angle θ = 2·atan2(s, w): twice that, and a rounding of at most 4u: < 48u;
/// * the axis: 20u/s + 3u. A rotation by φ ≤ θ is off by at most φ times that, and θ/s ≤ π since
///   s = sin(θ/2) ≥ θ/π: < 63u + 10u;
/// * R0 from q̂0: 12u + 10u;
/// * K R0 and K² R0, norms of entrywise errors (3 and 6 roundings, factor 3): 12u + 20u;
/// * φ = tθ, and sine and cosine (libm: 1 ulp): 4u + 2·2u;
/// * the sum of three matrices: 12u.
///
/// Together these terms are below 200u < 2^-45. The rotation vector adds h·(48u + 73u) ≤ 61u <
/// 2^-47. The sum of both is below 2^-44. The constant is twice that, to leave room for errors of
/// libm.
constexpr double kRotationError = 0x1p-43;

/// A term of every error, in metres. Squares below 2^-1022 underflow, and so lengths below 2^-511
/// are lost. For levers below 2^100 m, this term exceeds the effect of that loss on any bound.
constexpr double kLeastError = 0x1p-400;

}  // namespace

void RigidMotion::setLine(const Vec3& from, const Vec3& to) {
  from_ = from;
  delta_ = to - from;
  unsound_ = !delta_.allFinite() || !standardFloatingPoint();
  direction_ = delta_.stableNormalized();
}

void RigidMotion::setTube(const Tube& tube, double lengths) {
  fixedTube_ = lengths * tube.position;
  reachTube_ = tube.rotation;
  unsound_ = unsound_ || !(fixedTube_ >= 0 && fixedTube_ < HUGE_VAL && reachTube_ >= 0 &&
                           reachTube_ < HUGE_VAL);
}

void RigidMotion::setRotation(const Mat3& R0, const Vec3& axis, double angle, double angleError) {
  Mat3 K;
  K << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  R0_ = R0;
  KR0_ = K * R0;
  KKR0_ = K * KR0_;
  axis_ = axis;
  angle_ = angle;
  ambiguous_ = !(angle + angleError <= std::numbers::pi - kHalfTurnBand);
  unsound_ = unsound_ || !R0.allFinite();
}

RigidMotion RigidMotion::spatial(const RigidPose& from, const RigidPose& to, const Tube& tube) {
  // Dividing by the largest coefficient first keeps the norms of extreme quaternions finite. This
  // costs one more rounding.
  const auto normalised = [](const Eigen::Quaterniond& q) {
    const double largest = q.coeffs().cwiseAbs().maxCoeff();
    const Eigen::Vector4d scaled = q.coeffs() / largest;
    return Eigen::Quaterniond(Eigen::Vector4d(scaled / scaled.norm()));
  };
  RigidMotion m;
  m.setLine(from.p, to.p);
  const Eigen::Quaterniond q0 = normalised(from.q), q1 = normalised(to.q);
  const bool equal = from.q.coeffs() == to.q.coeffs() || from.q.coeffs() == -to.q.coeffs();
  Eigen::Quaterniond turn = q1 * q0.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double s = turn.vec().norm();
  const bool turns = !equal && s > 0;  // false for NaN, which would be a rest
  m.unsound_ = m.unsound_ || !turn.coeffs().allFinite();
  m.setRotation(q0.toRotationMatrix(), turns ? Vec3(turn.vec() / s) : Vec3::Zero(),
                turns ? 2 * std::atan2(s, turn.w()) : 0, 0);
  // p = p0 + t·δ. The values δ, t·δ and the sum are at most 2P, 2P and P, and each is rounded once.
  // The error is below 7uP per coordinate. Half of the interval's displacement, h·δ, adds less than
  // 2uP. As a length this is 9√3·uP < 16uP. The tube moves each coordinate by `position`.
  const double P = std::max(from.p.cwiseAbs().maxCoeff(), to.p.cwiseAbs().maxCoeff());
  m.setTube(tube, std::sqrt(3.0));
  m.fixedError_ = roundedUp(16 * kUnit * P + m.fixedTube_ + kLeastError);
  m.reachError_ = roundedUp(kRotationError + m.reachTube_);
  return m;
}

RigidMotion RigidMotion::translation(const Transform& from, const Vec3& delta) {
  RigidMotion m;
  m.setLine(from.t, from.t);
  m.delta_ = delta;
  m.direction_ = delta.stableNormalized();
  m.unsound_ = m.unsound_ || !delta.allFinite() || !(from.t + delta).allFinite();
  m.setRotation(from.m, Vec3::Zero(), 0, 0);
  // The error of the computed position is below 7uP, with P as defined below: t·δ and from.t + t·δ
  // are at most P, and each is rounded once. Another 16uP are for a caller that has rounded
  // `from.t` from a sum of terms below P (course/body_depth.cpp). The matrix itself has no error
  // along the path. But the bounds of the bodies assume a rotation. A matrix that does not mirror
  // differs from a rotation by at most 3·defect.
  const double P = from.t.cwiseAbs().maxCoeff() + delta.cwiseAbs().maxCoeff();
  m.fixedError_ = roundedUp(32 * kUnit * P + kLeastError);
  m.reachError_ = roundedUp(3 * orthonormalityDefect(from.m));
  return m;
}

RigidMotion RigidMotion::planar(const Vec3& from, const Vec3& to, const Tube& tube) {
  RigidMotion m;
  m.setLine(Vec3(from[0], from[1], 0), Vec3(to[0], to[1], 0));
  const double c = std::cos(from[2]), s = std::sin(from[2]);
  Mat3 R0;
  R0 << c, -s, 0, s, c, 0, 0, 0, 1;
  const CircleTurn turn = circleTurn(from[2], to[2]);
  m.setRotation(R0, turn.angle < 0 ? Vec3(0, 0, -1) : Vec3(0, 0, 1), std::abs(turn.angle),
                turn.error);
  const double P =
      std::max(from.head<2>().cwiseAbs().maxCoeff(), to.head<2>().cwiseAbs().maxCoeff());
  m.setTube(tube, std::sqrt(2.0));
  m.fixedError_ = roundedUp(16 * kUnit * P + m.fixedTube_ + kLeastError);
  m.reachError_ = roundedUp(kRotationError + turn.error + m.reachTube_);
  return m;
}

Transform RigidMotion::at(double t) const {
  const double phi = t * angle_;
  // 1 − cos φ cancels for small φ, but only its absolute error matters.
  return {R0_ + std::sin(phi) * KR0_ + (1 - std::cos(phi)) * KKR0_, from_ + t * delta_};
}

RelativeMotion RigidMotion::relativeMotion(double t, double h,
                                           std::span<ScrewMotion, 2> screws) const {
  RelativeMotion w;
  w.X_AB = at(t);
  w.linear = h * delta_;
  w.angular = (h * angle_) * axis_;
  w.speed = lengthFromAbove(w.linear);
  w.angle = h * angle_ == 0 ? 0 : roundedUp(h * angle_);
  std::size_t count = 0;
  if (w.speed > kTiny)
    screws[count++] = {ScrewMotion::Kind::prismatic, direction_, Vec3::Zero(), w.speed, 0};
  if (w.angle > kTiny) screws[count++] = {ScrewMotion::Kind::revolute, axis_, w.X_AB.t, w.angle, 0};
  w.screws = screws.first(count);
  w.fixedError = fixedError_;
  w.reachError = reachError_;
  w.fixedTube = fixedTube_;
  w.reachTube = reachTube_;
  return w;
}

}  // namespace corridor
