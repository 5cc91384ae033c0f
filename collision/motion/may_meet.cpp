#include "collision/motion/may_meet.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"

namespace corridor {

SweptSphere sweptSphere(const Body& b, const RelativeMotion& relative) {
  const Vec3 y = relative.X_AB.m * b.sphereCenter();
  const Vec3 c = y + relative.X_AB.t;
  const MotionBound bound = motionBound(relative, c, 0);
  // c is off by less than 8u of its terms per coordinate: 16u as a length. The computed map is
  // rigid up to `reachError`.
  const double radius = b.sphereRadius() * (1 + relative.reachError);
  const double terms = y.cwiseAbs().sum() + b.sphereRadius() + relative.X_AB.t.cwiseAbs().sum();
  SweptSphere sphere;
  sphere.center = c;
  sphere.radius = roundedUp(radius + bound.pad + 16 * kUnit * terms);
  sphere.isotropic = bound.isotropic;
  // y is off by 16u of its terms, as c is. The product and sum here add 16u, and so do those in
  // `bent` and `clearanceBound`; the direction itself adds 8u. Lengths below 2^-511 vanish when
  // squared.
  sphere.first = relative.linear + relative.angular.cross(y);
  sphere.angular = relative.angular;
  sphere.secondOrderAcross = bound.secondOrderAcross;
  sphere.secondOrder =
      roundedUp(bound.secondOrder + 0x1p-500 * (1 + bound.secondOrderAcross) +
                48 * kUnit * (relative.speed + relative.angle * (terms + bound.secondOrderAcross)));
  return sphere;
}

namespace {

/// Returns the share of `gap` metres, computed along (c_b − c_a)/gap, that remains after `radius`,
/// rounding and the motion. The motion is bounded by `isotropic`; if that does not suffice, by
/// `along(n)`.
template <class Along>
double remaining(const Vec3& apart, double gap, double radius, double isotropic, double rounding,
                 double enough, const Along& along) {
  if (!(gap < HUGE_VAL)) return 0;  // squares that overflow prove nothing
  const auto beyond = [&](double bound) {
    const double needed = roundedUp(radius + bound + rounding);
    return gap > needed ? std::max(0.0, roundedDown(roundedDown(gap) - needed)) : 0;
  };
  const double least = beyond(isotropic);
  if (least > enough || isotropic == 0 || !(gap > radius)) return least;
  const double bound = along(Vec3(apart / gap));
  return bound < isotropic ? beyond(bound) : least;
}

/// Returns the motion bound along the unit vector n beyond n·first.
double bent(const SweptSphere& sphere, const Vec3& n) {
  return n.cross(sphere.angular).norm() * sphere.secondOrderAcross + sphere.secondOrder;
}

}  // namespace

double clearanceBound(const Body& a, const SweptSphere& sphere, double enough) {
  const Vec3& c = sphere.center;
  const Vec3 zero = Vec3::Zero();
  const Vec3 outside = (c - a.upper()).cwiseMax(zero) - (a.lower() - c).cwiseMax(zero);
  // A square that underflows (to a subnormal, which may be rounded up) proves nothing. The
  // differences are off by u of both terms, √3 of that as a length. Along n the centre is `gap`
  // beyond the farthest point of the box.
  return remaining(outside, rootFromBelow(outside.squaredNorm()), sphere.radius, sphere.isotropic,
                   4 * kUnit * (c.cwiseAbs().sum() + a.boundTerms()), enough,
                   [&](const Vec3& n) { return std::abs(n.dot(sphere.first)) + bent(sphere, n); });
}

/// The direction is that of the line between the two centres at the middle. Along it the spheres
/// approach each other by the difference of their first-order displacements, and by the remainder
/// of each. The difference rounds by u of both: of the 48u of the speeds in each sphere's
/// secondOrder, `sweptSphere` uses 40u.
double clearanceBound(const SweptSphere& a, const SweptSphere& b, double enough) {
  const Vec3 apart = b.center - a.center;
  return remaining(
      apart, rootFromBelow(apart.squaredNorm()), a.radius + b.radius, a.isotropic + b.isotropic,
      4 * kUnit * (a.center.cwiseAbs().sum() + b.center.cwiseAbs().sum()), enough,
      [&](const Vec3& n) { return std::abs(n.dot(b.first - a.first)) + bent(a, n) + bent(b, n); });
}

}  // namespace corridor
