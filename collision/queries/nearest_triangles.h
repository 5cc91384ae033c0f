#pragma once

#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"
#include "collision/queries/nearest_pairs.h"

namespace corridor {

/// The triangles' side of a distance query: bounds the pairs that it is shown, in double, and
/// measures those that may be the closest again in double-double.
class NearestTriangles : public NearestPairs {
 public:
  /// For triangles within `reachA`, `reachB` of their frames' origins.
  NearestTriangles(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB,
                   const DistanceOptions& options, QueryContext& context)
      : NearestPairs(options, context),
        X_WA_(X_WA),
        X_WB_(X_WB),
        bounds_(X_WA, reachA, X_WB, reachB) {}

  /// Looks at a pair, by its numbers in leaf order; true where it is a contact: nothing can be
  /// closer.
  bool look(std::uint32_t s, const Triangle& a, std::uint32_t t, const Triangle& b,
            Counters& counters) {
    const DistanceRange range = bounds_(a, b);
    if (range.lower == 0 && touch(a, b, counters)) {
      keepContact(s, t);
      return true;
    }
    keep(s, t, range.lower, range.upper);
    return false;
  }

  /// The closest of all; `triangle(i)`, `meshTriangle(i)` give corners and numbers in the mesh.
  template <class TreeA, class TreeB>
  Distance result(const TreeA& a, const TreeB& b) {
    return closest(a, b, [&](std::uint32_t s, std::uint32_t t) {
      return closestPoints(a.triangle(s), X_WA_, b.triangle(t), X_WB_);
    });
  }

 private:
  bool touch(const Triangle& a, const Triangle& b, Counters& counters) const {
    Counters own;  // who shows a pair has counted it
    const bool touches = trianglesTouch(a, X_WA_, b, X_WB_, own);
    counters.exactTests += own.exactTests;
    return touches;
  }

  const Transform &X_WA_, &X_WB_;
  TriangleDistances bounds_;
};

}  // namespace corridor
