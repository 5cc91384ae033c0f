#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/queries/distance.h"

namespace corridor {

/// A pair of nodes or of leaf primitives (in leaf order), with a lower bound of its distance,
/// metres.
struct BoundedPair {
  std::uint32_t a, b;
  double bound;
};

/// The part of a distance query that tests leaf primitives, for any kind of trees. It keeps the
/// pairs that may be the closest, each with a proved lower bound of its distance. In the end it
/// measures these pairs with all digits.
class NearestPairs {
 public:
  /// @throws std::invalid_argument if an option is negative or NaN.
  NearestPairs(const DistanceOptions& options, QueryContext& context)
      : options_(options),
        relative_(options.relative + kTieShare),
        useOfCandidates_(context.scratch.use<Candidates>()),
        candidates_(useOfCandidates_->pairs),
        // If the distance is `upTo`, the options allow a slightly larger answer. A pair with this
        // larger distance must still pass `canImprove`, which applies `allowedFor` again.
        upper_((allowedFor(allowedFor(options.upTo))) * (1 + 0x1p-48)) {
    if (!(options.relative >= 0 && options.absolute >= 0 && options.upTo >= 0))
      throw std::invalid_argument("the options of a distance query must be 0 or more, and not NaN");
    candidates_.clear();
  }

  /// Returns the least upper bound of the distance so far, metres.
  double upper() const { return upper_; }

  /// Returns whether a pair that is at least `bound` metres apart may be closer than the best pair
  /// so far by more than the options allow. Always true for a pair that may touch (bound 0), so
  /// that only contact gives the distance 0. Also true for a NaN.
  bool canImprove(double bound) const {
    return bound == 0 || !(bound * (1 + relative_) + options_.absolute >= upper_);
  }

 private:
  double allowedFor(double distance) const {
    return distance * (1 + relative_) + options_.absolute;
  }

 protected:
  /// Keeps a pair of leaf primitives, numbered in leaf order, with a proved range of its distance,
  /// unless it can't improve the result.
  void keep(std::uint32_t s, std::uint32_t t, double lower, double upper) {
    if (!canImprove(lower)) return;
    if (upper < upper_) {
      upper_ = upper;
      std::erase_if(candidates_, [&](const auto& c) { return c.bound >= upper_; });
    }
    candidates_.push_back({s, t, lower});
  }
  /// Keeps only this pair. It touches, so no other pair can be closer.
  void keepContact(std::uint32_t s, std::uint32_t t) {
    candidates_.assign(1, {s, t, 0});
    contact_ = true;
  }
  bool contact() const { return contact_; }

  /// Returns the closest of the kept pairs. `measure(s, t)` returns `distance`, `p_WA` and `p_WB`.
  template <class TreeA, class TreeB, class Measure>
  Distance closest(const TreeA& a, const TreeB& b, const Measure& measure) {
    Distance best;
    best.distance = HUGE_VAL;
    std::sort(candidates_.begin(), candidates_.end(), [](const auto& x, const auto& y) {
      return x.bound < y.bound || (x.bound == y.bound && (x.a < y.a || (x.a == y.a && x.b < y.b)));
    });
    for (const auto& [s, t, bound] : candidates_) {
      if (bound * (1 + kTieShare) >= best.distance) break;
      const auto w = measure(s, t);
      if (!(w.distance < best.distance)) continue;
      best = {w.distance, w.p_WA, w.p_WB, a.meshTriangle(s), b.meshTriangle(t)};
    }
    // The result is 0 for contact, and only for contact.
    best.distance = contact_ ? 0 : std::max(best.distance, std::numeric_limits<double>::min());
    return best;
  }

 private:
  struct Candidates {
    std::vector<BoundedPair> pairs;
  };
  /// A part of the error 1e-12·d that distance.h allows. If the distances of two pairs differ by
  /// less than this part, one of the two need not be measured. Pairs of triangles around one corner
  /// are an example. Two such parts may add up: a pair that ruled out another pair may itself be
  /// ruled out by a third. If it is measured instead, the error 2^-41·d of `convexDistance`
  /// replaces the second part. In both cases the sum is below 1e-12·d and leaves room for rounding.
  static constexpr double kTieShare = 0.49e-12;

  const DistanceOptions& options_;
  double relative_;
  Scratch::Use<Candidates> useOfCandidates_;
  std::vector<BoundedPair>& candidates_;
  double upper_;
  bool contact_ = false;
};

}  // namespace corridor
