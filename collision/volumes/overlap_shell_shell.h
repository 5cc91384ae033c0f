#pragma once

#include "collision/volumes/overlap_sphere_sphere.h"
#include "collision/volumes/shell.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// Tests two spherical shells in three ways, the cheapest first:
/// 1. the spheres around both (overlap_sphere_sphere.h),
/// 2. the distances of all points of one shell from the centre of the other: all may be below its
///    inner radius, inside the hole, or above its outer radius,
/// 3. a direction that separates the hulls of both (direction_search.h).
/// Shells that none of these separates may still be disjoint.
///
/// Derivation. In frame A the image of shell b is {T + Mv} for its points v relative to its centre,
/// with T = M c_B + t − c_A, off by less than the margin `absolute` of `boxPairMargins`.
///
/// The unit vectors v of a cone have a largest product g(m) = max m·v with any m: |m| if m is in
/// the cone, else (m·axis + slope·|m × axis|)/√(1 + slope²). The least product is −g(−m). As
/// computed, g is off by less than 24u|m|, and by less than 2^-508 more if squares underflow.
/// Below, this adds less than 2^-507·outer to a square: less than 2u·outer² if outer > 2^-455, else
/// less than the 2^-960 that the slack of a square includes.
///
/// Distances: the squared distance from c_A of a point of b at s from its centre is
/// |T|² + 2s(MᵀT)·v + s²|Mv|², where |Mv|² is within 3η of 1. The largest is at s = inner or outer,
/// because the square is convex in s. The least is at s = −g/(1 − 3η), clamped. Both squares are
/// off by less than 64u(|T| + outer)². The distances of a from the centre of b are computed in the
/// same way, with η = 0, and the radii of b stretch by at most 1 ± 2η.
///
/// Directions: max n·d over the core is outer·g(n) if g(n) ≥ 0, else inner·g(n), for any map (n = m
/// for a, Mᵀn for b).
///
/// The margin relative·(|T|₁ + outer_A + outer_B + radii), of which `relative` exceeds 12η + 200u,
/// covers the rounding of all gaps, the stretch of radii, and |n| ≤ 1 + 4u.
template <>
class PairTest<Shell> {
 public:
  PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB, double error);

  bool separated(const Shell& a, const Shell& b, double pad) const;
  double distanceBound(const Shell& a, const Shell& b) const;

 private:
  struct Placed;  // a pair of shells
  double byDistances(const Placed& pair) const;
  double byDirections(const Placed& pair, double pad, double enough, double agreed) const;

  Transform X_AB_;
  PairTest<BoundingSphere> spheres_;
  BoxPairMargins margins_;
  double stretch_;  ///< 3η
};

}  // namespace corridor
