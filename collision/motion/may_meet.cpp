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
  // Rounding of the first-order term. y is off by 16u of its terms, like c. The products and sums
  // here, in `bent` and in `clearanceBound` together add less than 16u. The length of the direction
  // n adds 8u. The sum is 40u; 48u leaves room for the difference of two such terms. Lengths below
  // 2^-511 underflow when squared.
  sphere.first = relative.linear + relative.angular.cross(y);
  sphere.angular = relative.angular;
  sphere.secondOrderAcross = bound.secondOrderAcross;
  sphere.secondOrder =
      roundedUp(bound.secondOrder + 0x1p-500 * (1 + bound.secondOrderAcross) +
                48 * kUnit * (relative.speed + relative.angle * (terms + bound.secondOrderAcross)));
  return sphere;
}

namespace {

/// Returns a lower bound of what remains of a gap of `gap` metres along n = apart/gap, after
/// radius, rounding and motion are subtracted; at least 0. The bound of the motion is `isotropic`.
/// If the result is then at most `enough`, the bound of the motion is the smaller of `isotropic`
/// and `along(n)` instead.
template <class Along>
double remaining(const Vec3& apart, double gap, double radius, double isotropic, double rounding,
                 double enough, const Along& along) {
  if (!(gap < HUGE_VAL)) return 0;  // squares overflowed: nothing is proved
  const auto beyond = [&](double bound) {
    const double needed = roundedUp(radius + bound + rounding);
    return gap > needed ? std::max(0.0, roundedDown(roundedDown(gap) - needed)) : 0;
  };
  const double least = beyond(isotropic);
  if (least > enough || isotropic == 0 || !(gap > radius)) return least;
  const double bound = along(Vec3(apart / gap));
  return bound < isotropic ? beyond(bound) : least;
}

/// Returns the part of the motion bound along the unit vector n that is added to |n·first|.
double bent(const SweptSphere& sphere, const Vec3& n) {
  return n.cross(sphere.angular).norm() * sphere.secondOrderAcross + sphere.secondOrder;
}

}  // namespace

double clearanceBound(const BoundingBox& box, const SweptSphere& sphere, double enough) {
  const Vec3& c = sphere.center;
  const Vec3 zero = Vec3::Zero();
  const Vec3 outside = (c - box.upper).cwiseMax(zero) - (box.lower - c).cwiseMax(zero);
  // `rootOrZero` returns 0 if squares underflow; such a gap proves nothing. Each coordinate of the
  // differences is off by u of both terms; as a length, the error is √3 times as large. Along n the
  // centre is `gap` beyond the farthest point of the box.
  return remaining(outside, rootOrZero(outside.squaredNorm()), sphere.radius, sphere.isotropic,
                   4 * kUnit * (c.cwiseAbs().sum() + box.terms), enough,
                   [&](const Vec3& n) { return std::abs(n.dot(sphere.first)) + bent(sphere, n); });
}

/// The direction n is that of the line between the two centres at the middle. Along n the spheres
/// approach each other by at most the difference of their first-order displacements plus the
/// remainders of both. The difference rounds by u of both. The 48u of the speeds in each sphere's
/// `secondOrder` cover this: `sweptSphere` needs only 40u.
double clearanceBound(const SweptSphere& a, const SweptSphere& b, double enough) {
  const Vec3 apart = b.center - a.center;
  return remaining(
      apart, rootOrZero(apart.squaredNorm()), a.radius + b.radius, a.isotropic + b.isotropic,
      4 * kUnit * (a.center.cwiseAbs().sum() + b.center.cwiseAbs().sum()), enough,
      [&](const Vec3& n) { return std::abs(n.dot(b.first - a.first)) + bent(a, n) + bent(b, n); });
}

}  // namespace corridor
