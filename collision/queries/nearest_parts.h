#pragma once

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/queries/interference.h"
#include "collision/queries/nearest_pairs.h"
#include "collision/queries/touching_pairs.h"

namespace corridor {

/// The side of convex parts, or of parts and triangles, in a distance query, as `NearestTriangles`.
class NearestParts : public NearestPairs {
 public:
  NearestParts(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB,
               const DistanceOptions& options, QueryContext& context)
      : NearestPairs(options, context),
        X_WA_(X_WA),
        X_WB_(X_WB),
        // Twice the band of `convexSetsTouch`, at least.
        band_(0x1p-42 *
              (X_WA.m.norm() * reachA + X_WA.t.norm() + X_WB.m.norm() * reachB + X_WB.t.norm())),
        context_(context) {}

  /// Looks at a pair, by its numbers in leaf order; true where it touches.
  bool look(std::uint32_t s, const ConvexSet& a, std::uint32_t t, const ConvexSet& b,
            Counters& counters) {
    const PosedSet posedA(a, X_WA_), posedB(b, X_WB_);
    Counters own;  // who shows a pair has counted it
    const ConvexRange range = convexDistanceRange(posedA, posedB, upper(), 0, own);
    const bool touches = range.lower == 0 && convexSetsTouch(posedA, posedB, own);
    counters.exactTests += own.exactTests;
    if (touches)
      keepContact(s, t);
    else
      keep(s, t, range.lower, range.upper);
    return touches;
  }

  /// The closest of all. In the band of `convexSetsTouch`, where the volumes that another order of
  /// queries looks at may decide, it is `interference` that says what is contact.
  template <class Tree>
  Distance result(const Tree& a, const Tree& b) {
    const auto measure = [&](std::uint32_t s, std::uint32_t t) {
      Counters own;
      ConvexDistance d =
          convexDistance({convexSetOf(a, s), X_WA_}, {convexSetOf(b, t), X_WB_}, 0, 0, own);
      context_.counters.exactTests += own.exactTests;
      return d;
    };
    Distance best = closest(a, b, measure);
    if (!contact() && best.distance > band_) return best;
    --context_.counters.states;  // one query to its caller
    const bool touches = interference(a, X_WA_, b, X_WB_, context_).has_value();
    best.distance = touches ? 0 : std::max(best.distance, std::numeric_limits<double>::min());
    return best;
  }

 private:
  const Transform &X_WA_, &X_WB_;
  double band_;
  QueryContext& context_;
};

/// Likewise in a tolerance query: are two of them at most d apart?
class CloserParts {
 public:
  CloserParts(const Transform& X_WA, double, const Transform& X_WB, double, double d)
      : X_WA_(X_WA), X_WB_(X_WB), d_(d) {}

  /// `false` is a proof.
  bool operator()(const ConvexSet& a, const ConvexSet& b, Counters& counters) const {
    const PosedSet posedA(a, X_WA_), posedB(b, X_WB_);
    Counters own;
    const ConvexRange range = convexDistanceRange(posedA, posedB, d_, d_, own);
    bool closer = range.upper <= d_;
    if (!closer && !(range.lower > d_))
      closer = !(convexDistance(posedA, posedB, 0, 0, own).lower > d_);
    counters.exactTests += own.exactTests;
    return closer;
  }

 private:
  const Transform &X_WA_, &X_WB_;
  double d_;
};

}  // namespace corridor
