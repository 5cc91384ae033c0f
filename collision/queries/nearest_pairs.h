#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/queries/distance.h"

namespace corridor {

/// The items' side of a distance query, whatever trees and items: keeps the pairs that may be the
/// closest by ranges of their distances, to be measured again with all digits.
class NearestPairs {
 public:
  /// Its list is the context's.
  NearestPairs(const DistanceOptions& options, QueryContext& context)
      : options_(options), relative_(options.relative + kGiven), candidates_(context.candidates) {
    candidates_.clear();
  }

  /// An upper bound of the distance so far, metres.
  double upper() const { return upper_; }

  /// Might something at least `bound` away be closer than the best by more than the options allow?
  /// What may touch always might, so that only contact is 0; and so might a NaN.
  bool canImprove(double bound) const {
    return bound == 0 || !(bound * (1 + relative_) + options_.absolute >= upper_);
  }

 protected:
  /// A pair of items, in leaf order, and a proved range of its distance.
  void keep(std::uint32_t s, std::uint32_t t, double lower, double upper) {
    if (!canImprove(lower)) return;
    if (upper < upper_) {
      upper_ = upper;
      std::erase_if(candidates_, [&](const auto& c) { return c.bound >= upper_; });
    }
    candidates_.push_back({s, t, lower});
  }
  /// A pair that touches: nothing can be closer.
  void keepContact(std::uint32_t s, std::uint32_t t) {
    candidates_.assign(1, {s, t, 0});
    contact_ = true;
  }
  bool contact() const { return contact_; }

  /// The closest of all by `measure(s, t)`, which gives `distance`, `p_WA` and `p_WB`.
  template <class TreeA, class TreeB, class Measure>
  Distance closest(const TreeA& a, const TreeB& b, const Measure& measure) {
    Distance best;
    best.distance = HUGE_VAL;
    std::sort(candidates_.begin(), candidates_.end(), [](const auto& x, const auto& y) {
      return x.bound < y.bound || (x.bound == y.bound && (x.a < y.a || (x.a == y.a && x.b < y.b)));
    });
    for (const auto& [s, t, bound] : candidates_) {
      if (bound * (1 + kGiven) >= best.distance) break;
      const auto w = measure(s, t);
      if (!(w.distance < best.distance)) continue;
      best = {w.distance, w.p_WA, w.p_WB, a.meshTriangle(s), b.meshTriangle(t)};
    }
    // Only contact is 0, and what is not contact is not.
    best.distance = contact_ ? 0 : std::max(best.distance, std::numeric_limits<double>::min());
    return best;
  }

 private:
  /// Of the 1e-12·d that distance.h grants: pairs that tie but for that, as all triangles about one
  /// corner do, are measured once. Twice, since what ruled a pair out may be left unmeasured
  /// itself; where it is measured, `convexDistance` takes 2^-41. Both leave room for rounding.
  static constexpr double kGiven = 0.49e-12;

  const DistanceOptions& options_;
  double relative_;
  std::vector<QueryContext::BoundedPair>& candidates_;
  double upper_ = HUGE_VAL;
  bool contact_ = false;
};

}  // namespace corridor
