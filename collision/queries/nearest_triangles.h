#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"
#include "collision/queries/distance.h"

namespace corridor {

/// The triangles' side of a distance query, whatever the trees: bounds the pairs that it is shown,
/// in double, and keeps those that may be the closest, to be measured again in double-double.
class NearestTriangles {
 public:
  /// For triangles within `reachA`, `reachB` of their frames' origins. Its list is the context's.
  NearestTriangles(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB,
                   const DistanceOptions& options, QueryContext& context)
      : X_WA_(X_WA),
        X_WB_(X_WB),
        options_(options),
        bounds_(X_WA, reachA, X_WB, reachB),
        candidates_(context.candidates) {
    candidates_.clear();
  }

  /// An upper bound of the distance so far, metres.
  double upper() const { return upper_; }

  /// Might something at least `bound` away be closer than the best by more than the options allow?
  /// What may touch always might, so that only contact is 0; and so might a NaN.
  bool canImprove(double bound) const {
    return bound == 0 || !(bound * (1 + options_.relative) + options_.absolute >= upper_);
  }

  /// Looks at a pair, by its numbers in leaf order; true where it is a contact: nothing can be
  /// closer.
  bool look(std::uint32_t s, const Triangle& a, std::uint32_t t, const Triangle& b,
            Counters& counters) {
    const DistanceRange range = bounds_(a, b);
    if (range.lower == 0 && touch(a, b, counters)) {
      candidates_.assign(1, {s, t, 0});
      contact_ = true;
      return true;
    }
    if (!canImprove(range.lower)) return false;
    candidates_.push_back({s, t, range.lower});
    if (range.upper < upper_) {
      upper_ = range.upper;
      std::erase_if(candidates_, [&](const auto& c) { return c.bound >= upper_; });
    }
    return false;
  }

  /// The closest of all; `triangleA(i)`, `numberA(i)` and b's give corners and numbers in the mesh.
  template <class TreeA, class TreeB>
  Distance result(const TreeA& a, const TreeB& b) {
    Distance best;
    best.distance = HUGE_VAL;
    std::sort(candidates_.begin(), candidates_.end(), [](const auto& x, const auto& y) {
      return x.bound < y.bound || (x.bound == y.bound && (x.a < y.a || (x.a == y.a && x.b < y.b)));
    });
    for (const auto& [s, t, bound] : candidates_) {
      if (bound >= best.distance) break;
      const WitnessPoints w = closestPoints(a.triangle(s), X_WA_, b.triangle(t), X_WB_);
      if (!(w.distance < best.distance)) continue;
      best = {w.distance, w.p_WA, w.p_WB, a.meshTriangle(s), b.meshTriangle(t)};
    }
    // Only contact is 0, and what is not contact is not.
    best.distance = contact_ ? 0 : std::max(best.distance, std::numeric_limits<double>::min());
    return best;
  }

 private:
  bool touch(const Triangle& a, const Triangle& b, Counters& counters) const {
    Counters own;  // who shows a pair has counted it
    const bool touches = trianglesTouch(a, X_WA_, b, X_WB_, own);
    counters.exactTests += own.exactTests;
    return touches;
  }

  const Transform &X_WA_, &X_WB_;
  const DistanceOptions& options_;
  TriangleDistances bounds_;
  std::vector<QueryContext::BoundedPair>& candidates_;
  double upper_ = HUGE_VAL;
  bool contact_ = false;
};

}  // namespace corridor
