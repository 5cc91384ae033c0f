#pragma once

#include <vector>

#include "collision/geometry/convex_part.h"
#include "planner/verify/edge_curve.h"

namespace corridor::verify {

/// A convex set in the verifier's arithmetic: the hull of `points` swept by a ball of `radius`; or,
/// with `flatEnds`, of two points swept by a disc of `radius` at a right angle to `axis`. A
/// triangle has three points and radius 0.
struct ConvexSet {
  std::vector<RealVec> points;
  Real radius = 0;
  bool flatEnds = false;
  RealVec axis = RealVec::Zero();  ///< unit; flatEnds only

  /// The point of the set, less its ball, that lies farthest along `direction`.
  RealVec farthest(const RealVec& direction) const;
  /// The radius of the ball: 0 with flat ends.
  Real ball() const { return flatEnds ? 0 : radius; }
};

/// `part` under a rigid map.
ConvexSet placed(const ConvexPart& part, const Placement& placement);

/// The distance of two convex sets, bracketed, as TriangleGap says: `upper` from witness points,
/// `lower` from a slab; any direction gives a true bound. Found by the point of least norm of the
/// difference of the sets' cores, from at most four of its corners at a time (Gilbert, Johnson,
/// Keerthi 1988); which of them is settled by trying all subsets, as is plainest.
/// Rounding as for triangles: 2^-50 of the size covers it amply.
/// @param guess where the search starts: a direction from a to b, of any length; 0 for none.
/// @param enough a distance that needn't be told from a larger one: `lower` of this much ends it.
TriangleGap convexGap(const ConvexSet& a, const ConvexSet& b,
                      const RealVec& guess = RealVec::Zero(),
                      Real enough = std::numeric_limits<Real>::infinity());

}  // namespace corridor::verify
