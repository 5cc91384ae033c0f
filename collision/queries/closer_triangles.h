#pragma once

#include "collision/core/counters.h"
#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"

namespace corridor {

/// Tests whether two triangles are at most `d` apart: the leaf test of tolerance queries, for any
/// kind of tree. The object keeps references to both maps, so the maps must outlive it.
class CloserTriangles {
 public:
  /// @param reachA, reachB  metres: each triangle lies within this distance of its frame's origin.
  /// @param d  metres.
  CloserTriangles(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB,
                  double d)
      : X_WA_(X_WA), X_WB_(X_WB), bounds_(X_WA, reachA, X_WB, reachB), d_(d) {}

  /// Tests bounds in double first, then contact, then the distance in double-double. `closerThan`
  /// (distance.h) states how exact the answer is.
  bool operator()(const Triangle& a, const Triangle& b, Counters& counters) const {
    const DistanceRange range = bounds_(a, b);
    if (range.lower > d_) return false;
    if (range.upper <= d_) return true;
    const PredicateResult touches = trianglesTouch(a, X_WA_, b, X_WB_);
    counters.exactTests += touches.exact;  // the caller has counted the pair
    if (touches) return true;
    const WitnessPoints w = witnessPoints(a, X_WA_, b, X_WB_);
    return w.distance <= roundedUp(d_ + w.error);
  }

 private:
  const Transform &X_WA_, &X_WB_;
  TriangleDistances bounds_;
  double d_;
};

}  // namespace corridor
