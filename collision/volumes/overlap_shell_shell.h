#pragma once

#include "collision/volumes/overlap_sphere_sphere.h"
#include "collision/volumes/shell.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// Tests two spherical shells in three ways, the cheapest first, by:
/// 1. the spheres around both (overlap_sphere_sphere.h),
/// 2. the distances of all points of one shell from the centre of the other shell: the shells are
///    separated if all these distances are below the other shell's inner radius, or all above its
///    outer radius,
/// 3. a direction that separates the hulls of both (direction_search.h).
///
/// Shells that none of these tests separates may still be disjoint.
///
/// Derivation. Let x ↦ M x + t be the map from b's frame to a's, c_A and c_B the centres, η the
/// defect of M from a rotation, and u = 2^-53. Relative to c_A, the image of shell b is {T + Mv}
/// for the shell's points v relative to c_B. T = M c_B + t − c_A is computed with an error below
/// the margin `absolute` of `boxPairMargins`.
///
/// The unit vectors v of a cone have a largest product g(m) = max m·v with any m: |m| if m is in
/// the cone, else (m·axis + slope·|m × axis|)/√(1 + slope²). The least product is −g(−m). The
/// computed g is off by less than 24u|m|, and by less than 2^-508 more if squares underflow. This
/// underflow adds less than 2^-507·outer to a squared distance below: less than 2u·outer² if outer
/// > 2^-455, else less than the 2^-960 that the slack of a square includes.
///
/// Distances: the squared distance from c_A of a point of b at s from its centre is |T|² +
/// 2s(MᵀT)·v + s²|Mv|², where |Mv|² is within 3η of 1. The largest squared distance is at s = inner
/// or outer, because it is convex in s. The least is at s = −g/(1 − 3η), clamped to [inner, outer],
/// with g the least product of MᵀT and a unit vector of the cone. Both squares are off by less than
/// 64u(|T| + outer)². The distances of the points of a from the centre of b are computed in the
/// same way, with η = 0. The map changes the radii of b by at most the factor 1 ± 2η.
///
/// Directions: max m·d over a core is outer·g(m) if g(m) ≥ 0, else inner·g(m). For a direction n
/// from a to b, m is n for shell a and −Mᵀn for shell b. This holds for any map.
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
  struct Placed;  // a pair of shells, with T and the margins
  double byDistances(const Placed& pair) const;
  double byDirections(const Placed& pair, double pad, double enough, double agreed) const;

  Transform X_AB_;
  PairTest<BoundingSphere> spheres_;
  BoxPairMargins margins_;
  double stretch_;  ///< 3η
};

}  // namespace corridor
