#include "planner/checker/rigid_state.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace corridor {
namespace {

using Eigen::Quaterniond;
using std::numbers::pi;

/// Angle between unit quaternions taken as rotations, in [0, π/2], well conditioned everywhere: the
/// arc cosine that OMPL takes loses half of the digits near 0. `b` is to be negated where the dot
/// product is negative, which the caller does.
double halfAngle(const Quaterniond& a, const Quaterniond& b) {
  return 2 * std::atan2((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

Quaterniond nearer(const Quaterniond& a, const Quaterniond& b) {
  return a.dot(b) < 0 ? Quaterniond(-b.coeffs()) : b;
}

Quaterniond slerp(const Quaterniond& from, const Quaterniond& to, double t) {
  const Quaterniond a = from.normalized(), b = nearer(a, to.normalized());
  const double angle = halfAngle(a, b);
  // sin(tθ)/sin θ = t(1 + θ²(1 − t²)/6 + …): under 2^-27 it is t to half an ulp.
  const bool tiny = angle < 0x1p-27;
  const double wa = tiny ? 1 - t : std::sin((1 - t) * angle) / std::sin(angle);
  const double wb = tiny ? t : std::sin(t * angle) / std::sin(angle);
  return Quaterniond(Eigen::Vector4d(wa * a.coeffs() + wb * b.coeffs())).normalized();
}

/// The shorter way round; −π or π for a half turn. Exact remainders of the double 2π, which is
/// 2^-52 off.
double turn(double from, double to) {
  return std::remainder(to - from, 2 * pi);
}

double intoCircle(double yaw) {
  return std::abs(yaw) <= pi ? yaw : std::remainder(yaw, 2 * pi);
}

}  // namespace

RigidState interpolate(RigidSpace space, const RigidState& from, const RigidState& to, double t) {
  RigidState at = t == 0 ? from : to;
  if (t != 0 && t != 1) {
    const Vec3 &p = from.pose.p, &q = to.pose.p;
    at.pose.p = (p + (q - p) * t).cwiseMax(p.cwiseMin(q)).cwiseMin(p.cwiseMax(q));
    if (space == RigidSpace::SE3)
      at.pose.q = slerp(from.pose.q, to.pose.q, t);
    else
      at.yaw = from.yaw + t * turn(from.yaw, to.yaw);
  }
  if (space == RigidSpace::SE2) at.yaw = intoCircle(at.yaw);
  return at;
}

double rotationAngle(RigidSpace space, const RigidState& a, const RigidState& b) {
  if (space == RigidSpace::SE2) return std::abs(turn(a.yaw, b.yaw));
  const Quaterniond p = a.pose.q.normalized(), q = b.pose.q.normalized();
  return 2 * halfAngle(p, nearer(p, q));
}

double distance(RigidSpace space, double rotationWeight, const RigidState& a, const RigidState& b) {
  const double angle = rotationAngle(space, a, b);
  return (b.pose.p - a.pose.p).norm() +
         rotationWeight * (space == RigidSpace::SE3 ? angle / 2 : angle);
}

bool ambiguous(RigidSpace space, const RigidState& a, const RigidState& b) {
  return pi - rotationAngle(space, a, b) <= 1e-9;
}

Transform placement(RigidSpace space, const RigidState& state) {
  if (space == RigidSpace::SE3) return {state.pose.q.normalized().toRotationMatrix(), state.pose.p};
  Transform X;
  const double c = std::cos(state.yaw), s = std::sin(state.yaw);
  X.m << c, -s, 0, s, c, 0, 0, 0, 1;
  X.t = {state.pose.p.x(), state.pose.p.y(), 0};
  return X;
}

}  // namespace corridor
