#pragma once

#include <vector>

#include "collision/geometry/convex_part.h"
#include "planner/verify/edge_curve.h"

namespace corridor::verify {

/// A convex set in the verifier's arithmetic: the hull of `points` swept by a sphere of `radius`.
/// With `flatEnds`, the set is a cylinder: the segment of two points swept by a disc of `radius`
/// that is perpendicular to `axis`. A triangle has three points and radius 0.
struct ConvexSet {
  std::vector<RealVec> points;
  Real radius = 0;
  bool flatEnds = false;
  RealVec axis = RealVec::Zero();  ///< unit; flatEnds only

  /// Returns the point of the set, without its swept sphere, that is farthest along `direction`.
  /// With `flatEnds` the disc is included.
  RealVec farthest(const RealVec& direction) const;
  /// Returns the radius of the swept sphere, which is 0 with flat ends.
  Real sweptRadius() const { return flatEnds ? 0 : radius; }
};

/// Returns `part` under a rigid map.
ConvexSet placed(const ConvexPart& part, const Placement& placement);

/// Returns a lower and an upper bound of the distance of two convex sets, as DistanceBounds
/// describes: `upper` is the distance of the witness points, `lower` the width of a slab. A slab in
/// any direction gives a true bound.
///
/// Method (Gilbert, Johnson, Keerthi 1988): finds the point of least norm in the difference of the
/// two sets without their swept spheres. Each step has at most four corners of this difference, and
/// keeps the subset whose hull contains the point of least norm. It finds this subset by trying all
/// subsets that contain the newest corner, which is the simplest way. The rounding errors are of
/// the size that DistanceBounds states, and far below 2^-50 of the largest norm of a point.
/// @param guess the direction in which the search starts, from a to b, of any length. Zero: no
/// guess.
/// @param enough the search ends when `lower` reaches this value.
DistanceBounds convexGap(const ConvexSet& a, const ConvexSet& b,
                         const RealVec& guess = RealVec::Zero(),
                         Real enough = std::numeric_limits<Real>::infinity());

}  // namespace corridor::verify
