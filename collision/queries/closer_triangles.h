#pragma once

#include "collision/core/counters.h"
#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"

namespace corridor {

/// The triangles' side of a tolerance query, whatever the trees: are two of them at most d apart?
class CloserTriangles {
 public:
  /// For triangles within `reachA`, `reachB` of their frames' origins; d in metres.
  CloserTriangles(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB,
                  double d)
      : X_WA_(X_WA), X_WB_(X_WB), bounds_(X_WA, reachA, X_WB, reachB), d_(d) {}

  /// Bounds in double first, contact next, double-double last (`closerThan` tells the exactness).
  bool operator()(const Triangle& a, const Triangle& b, Counters& counters) const {
    const DistanceRange range = bounds_(a, b);
    if (range.lower > d_) return false;
    if (range.upper <= d_) return true;
    Counters own;  // who shows a pair has counted it
    const bool touches = trianglesTouch(a, X_WA_, b, X_WB_, own);
    counters.exactTests += own.exactTests;
    if (touches) return true;
    const WitnessPoints w = closestPoints(a, X_WA_, b, X_WB_);
    return w.distance <= roundedUp(d_ + w.error);
  }

 private:
  const Transform &X_WA_, &X_WB_;
  TriangleDistances bounds_;
  double d_;
};

}  // namespace corridor
