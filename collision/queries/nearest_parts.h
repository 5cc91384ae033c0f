#pragma once

#include <algorithm>
#include <concepts>

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/queries/nearest_pairs.h"
#include "collision/queries/obb4_leaf_set.h"
#include "collision/queries/touching_pairs.h"

namespace corridor {

/// Calls `f(set of a, set of b)` with two leaf primitives as convex sets, numbered in leaf order.
template <class Tree, class F>
auto withLeafSets(const Tree& a, std::uint32_t s, const Tree& b, std::uint32_t t, const F& f) {
  if constexpr (std::same_as<Tree, Obb4Tree>) {
    const Obb4LeafSet setA(a, s), setB(b, t);
    return f(setA.set(), setB.set());
  } else {
    return f(convexSetOf(a, s), convexSetOf(b, t));
  }
}

/// The part of a distance query that tests leaf primitives if at least one tree holds convex parts.
/// `NearestTriangles` is its counterpart for triangles.
///
/// Within the band of `convexSetsTouch`, a contact of two leaf primitives is not proved, and the
/// volumes above them may prove that they are apart. `interference` then reports no contact, and
/// the distance must not be 0, but right. In this rare case (`isDenied`), the search is repeated
/// with the knowledge that no primitives touch (`takeAsApart`).
class NearestParts : public NearestPairs {
 public:
  NearestParts(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB,
               const DistanceOptions& options, QueryContext& context)
      : NearestPairs(options, context),
        X_WA_(X_WA),
        X_WB_(X_WB),
        // At least twice the band of `convexSetsTouch`, metres.
        band_(0x1p-42 *
              (X_WA.m.norm() * reachA + X_WA.t.norm() + X_WB.m.norm() * reachB + X_WB.t.norm())),
        context_(context) {}

  /// Bounds the distance of a pair of leaf primitives, numbered in leaf order, and keeps the pair
  /// if it may be the closest. Returns whether the two touch; always false after `takeAsApart`.
  bool testPair(std::uint32_t s, const ConvexSet& a, std::uint32_t t, const ConvexSet& b,
                Counters& counters) {
    const PosedSet posedA(a, X_WA_), posedB(b, X_WB_);
    const ConvexRange range = convexDistanceRange(posedA, posedB, upper(), 0);
    const PredicateResult touches =
        range.lower == 0 && !apart_ ? convexSetsTouch(posedA, posedB) : PredicateResult{};
    counters.exactTests += touches.exact;  // the caller has counted the pair
    if (touches)
      keepContact(s, t);
    else  // a range that begins at 0 may be a contact in double: its end is then no upper bound
      keep(s, t, range.lower, range.lower == 0 ? std::max(range.upper, band_) : range.upper);
    return touches;
  }

  /// Takes it as known that no primitives touch. Must be called before the search.
  void takeAsApart() { apart_ = true; }
  /// Returns whether the search found a contact, but `interference` reports none. Then the search
  /// must be repeated after `takeAsApart`.
  template <class Tree>
  bool isDenied(const Tree& a, const Tree& b) {
    if (!contact()) return false;
    return !interference(Posed(a, X_WA_), Posed(b, X_WB_), context_);
  }

  /// Returns the closest pair. Within the band of `convexSetsTouch` the verdict may depend on the
  /// order of the tests. There `interference` decides, so that both queries agree.
  /// @pre `isDenied` is false.
  template <class Tree>
  Distance result(const Tree& a, const Tree& b) {
    const auto measure = [&](std::uint32_t s, std::uint32_t t) {
      return withLeafSets(a, s, b, t, [&](const ConvexSet& setA, const ConvexSet& setB) {
        const PosedSet posedA(setA, X_WA_), posedB(setB, X_WB_);
        ConvexDistance d = convexDistance(posedA, posedB);
        if (d.distance == 0 && !contact()) d = separatedDistance(posedA, posedB, {});
        context_.counters.exactTests += d.exact;
        return d;
      });
    };
    Distance best = closest(a, b, measure);
    if (contact() || apart_ || best.distance > band_) return best;
    if (interference(Posed(a, X_WA_), Posed(b, X_WB_), context_)) best.distance = 0;
    return best;
  }

 private:
  const Transform &X_WA_, &X_WB_;
  double band_;
  QueryContext& context_;
  bool apart_ = false;
};

/// Tests whether two leaf primitives are at most d apart: the leaf test of tolerance queries on
/// convex parts, or on convex parts and triangles.
class CloserParts {
 public:
  CloserParts(const Transform& X_WA, double, const Transform& X_WB, double, double d)
      : X_WA_(X_WA), X_WB_(X_WB), d_(d) {}

  /// Returning `false` is a proof that the sets are farther apart than d.
  bool operator()(const ConvexSet& a, const ConvexSet& b, Counters& counters) const {
    const PosedSet posedA(a, X_WA_), posedB(b, X_WB_);
    const ConvexRange range = convexDistanceRange(posedA, posedB, d_, d_);
    if (range.upper <= d_) return true;
    if (range.lower > d_) return false;
    const ConvexDistance distance = convexDistance(posedA, posedB);
    counters.exactTests += distance.exact;
    return !(distance.lower > d_);
  }

 private:
  const Transform &X_WA_, &X_WB_;
  double d_;
};

}  // namespace corridor
