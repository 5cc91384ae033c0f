#pragma once

#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"
#include "collision/queries/nearest_pairs.h"

namespace corridor {

/// The part of a distance query that tests leaf primitives, for triangles. Bounds the distance of
/// each pair in double. In the end, measures the pairs that may be the closest in double-double.
class NearestTriangles : public NearestPairs {
 public:
  /// @param reachA, reachB  metres: each triangle lies within this distance of its frame's origin.
  NearestTriangles(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB,
                   const DistanceOptions& options, QueryContext& context)
      : NearestPairs(options, context),
        X_WA_(X_WA),
        X_WB_(X_WB),
        bounds_(X_WA, reachA, X_WB, reachB) {}

  /// Bounds the distance of a pair of triangles, numbered in leaf order, and keeps the pair if it
  /// may be the closest. Returns true if the two touch: then no other pair can be closer.
  bool testPair(std::uint32_t s, const Triangle& a, std::uint32_t t, const Triangle& b,
                Counters& counters) {
    const DistanceRange range = bounds_(a, b);
    if (range.lower == 0 && touch(a, b, counters)) {
      keepContact(s, t);
      return true;
    }
    keep(s, t, range.lower, range.upper);
    return false;
  }

  /// Returns the closest pair. The trees' `triangle(i)` returns corners, `meshTriangle(i)` the
  /// number in the mesh.
  template <class TreeA, class TreeB>
  Distance result(const TreeA& a, const TreeB& b) {
    return closest(a, b, [&](std::uint32_t s, std::uint32_t t) {
      return witnessPoints(a.triangle(s), X_WA_, b.triangle(t), X_WB_);
    });
  }

 private:
  bool touch(const Triangle& a, const Triangle& b, Counters& counters) const {
    const PredicateResult touches = trianglesTouch(a, X_WA_, b, X_WB_);
    counters.exactTests += touches.exact;  // the caller has counted the pair
    return touches;
  }

  const Transform &X_WA_, &X_WB_;
  TriangleDistances bounds_;
};

}  // namespace corridor
