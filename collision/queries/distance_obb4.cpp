#include "collision/queries/distance_obb4.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <tuple>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closer_triangles.h"
#include "collision/queries/distance_obb4_parts.h"
#include "collision/queries/interference_obb4.h"
#include "collision/queries/nearest_triangles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/queries/distance_obb4.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/hierarchy/obb4_walk-inl.h"
#include "collision/queries/boxes_within-inl.h"
#include "collision/queries/obb4_leaves-inl.h"
#include "collision/queries/triangle_distances-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// The distance query on two 4-wide OBB trees of triangles. Bounds pairs of triangles in float,
/// sixteen at a time. Pairs that may be the closest are bounded again in double. Those that may
/// then still be the closest are measured in double-double.
class Nearest : public BoxesWithin<true> {
 public:
  Nearest(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
          const DistanceOptions& options, QueryContext& context)
      : BoxesWithin(a, b, pose, options.upTo, context.counters),
        options_(options),
        leaves_(a_, b_, pose, counters_),
        useOfCandidates_(context.scratch.use<Candidates>()),
        candidates_(useOfCandidates_->pairs),
        nearest_(a.X_W, a_.reach(), b.X_W, b_.reach(), options, context) {
    candidates_.clear();
  }

  /// Measures leaf pairs in batches of at most sixteen pairs of triangles. The nearest leaf pairs
  /// come first, because they may rule out the others.
  bool leaves(const NodePair4&, const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned pairs,
              const float* keys) {
    while (pairs) {
      NodeLeafPairs some(na, nb);
      while (pairs) {
        const unsigned least = leastOf(pairs, keys);
        if (isBeyond(keys[least])) pairs = 0;
        if (!pairs || (some.count() && some.count() + some.sizeOf(least) > 16)) break;
        some.add(least);
        pairs &= ~(1U << least);
      }
      if (some.count()) measure(some);
    }
    return false;
  }

  /// Starts from a pair of triangles, numbered in leaf order and at most `upper` metres apart.
  void start(std::uint32_t s, std::uint32_t t, double upper) {
    const float limit = pose_.inUnitsOfA(upper);
    if (!(limit < HUGE_VALF)) return;
    least_ = limit;
    closest_ = {s, t};
    reduceLimit(upper);
  }
  /// Returns the pair with the least upper bound, for the next query to start from.
  std::optional<PrimitivePair> closest() const {
    return least_ < HUGE_VALF ? std::optional(closest_) : std::nullopt;
  }

  Distance result() {
    // Tests `closest_` first. This pair has set the limit, which is reduced by the allowed error.
    // So the limit may be below the pair's own bound, and the loop would skip the pair.
    if (least_ < HUGE_VALF) testPair(closest_.a, closest_.b);
    std::erase_if(candidates_, [&](const auto& c) { return c.bound > limit_; });
    std::ranges::sort(candidates_, {}, [](const auto& c) { return std::tuple(c.bound, c.a, c.b); });
    for (const auto& [s, t, bound] : candidates_)
      if (!(bound > limit_) && !(s == closest_.a && t == closest_.b)) testPair(s, t);
    return nearest_.result(a_, b_);
  }

 private:
  struct Candidates {
    std::vector<BoundedPair> pairs;
  };

  void measure(NodeLeafPairs& pairs) {
    leaves_.forEachNearSixteen(
        pairs, [&] { return limit_; },
        [&](const TriangleCorners& a, const TriangleCorners& b, unsigned first, unsigned open) {
          alignas(64) float lower[16], upper[16];
          triangleDistances(a, b, pairs.from(first), pose_.leafError, lower, upper);
          for (unsigned rest = open; rest; rest &= rest - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(rest));
            if (!(upper[bit] < least_)) continue;
            least_ = upper[bit];
            closest_ = pairs.triangles(first + bit);
          }
          if (least_ < HUGE_VALF) reduceLimit(least_ / pose_.unitA * (2 - pose_.shrink));
          for (unsigned rest = open; rest; rest &= rest - 1) {
            const auto bit = static_cast<unsigned>(std::countr_zero(rest));
            const auto [s, t] = pairs.triangles(first + bit);
            if (upper[bit] == HUGE_VALF) {  // too far apart for floats, so bounded in double
              testPair(s, t);
            } else if (!(lower[bit] > limit_)) {
              candidates_.push_back({s, t, lower[bit]});
            }
          }
          return false;
        });
  }

  void testPair(std::uint32_t s, std::uint32_t t) {
    nearest_.testPair(s, a_.triangle(s), t, b_.triangle(t), counters_);
    reduceLimit(nearest_.upper());
  }
  void reduceLimit(double metres) { BoxesWithin::reduceLimit(metres, options_); }

  const DistanceOptions& options_;
  Obb4Leaves leaves_;
  /// Pairs of triangles, numbered in leaf order, with lower bounds of their distances in a's unit.
  Scratch::Use<Candidates> useOfCandidates_;
  std::vector<BoundedPair>& candidates_;
  NearestTriangles nearest_;
  float least_ = HUGE_VALF;  // least upper bound so far, in a's unit
  PrimitivePair closest_;    // the pair with that bound, in leaf order
};

Distance obb4Distance(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
                      const DistanceOptions& options, QueryContext& context, LastPair* last) {
  const Obb4Tree &treeA = a.shape, &treeB = b.shape;
  Nearest query(a, b, pose, options, context);
  if (last && last->isIn(treeA.triangleCount(), treeB.triangleCount())) {
    const TriangleDistances bounds(a.X_W, treeA.reach(), b.X_W, treeB.reach());
    query.start(last->a, last->b, bounds(treeA.triangle(last->a), treeB.triangle(last->b)).upper);
    ++context.counters.primitiveTests;
  }
  walkObb4(treeA, treeB, pose.floats.scale, kWholeTrees, *context.scratch.use<Obb4Stack>(),
           context.counters, query);
  if (const auto closest = query.closest(); closest && last)
    last->recordFound(closest->a, closest->b);
  return query.result();
}

/// The tolerance query on two 4-wide OBB trees of triangles.
class Closer : public BoxesWithin<false> {
 public:
  Closer(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose, double d,
         Counters& counters)
      : BoxesWithin(a, b, pose, d, counters),
        leaves_(a_, b_, pose, counters),
        closer_(a.X_W, a_.reach(), b.X_W, b_.reach(), d) {}

  static bool skip(const NodePair4&) { return false; }  // since the limit never shrinks

  bool leaves(const NodePair4&, const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned pairs,
              const float*) {
    found_ = leaves_.forEachNear(
        na, nb, pairs, [&] { return limit_; },
        [&](std::uint32_t s, std::uint32_t t) {
          if (!closer_(a_.triangle(s), b_.triangle(t), counters_)) return false;
          pair_ = {s, t};
          return true;
        });
    return found_;
  }

  std::optional<PrimitivePair> found() const {
    return found_ ? std::optional(pair_) : std::nullopt;
  }

 private:
  Obb4Leaves leaves_;
  CloserTriangles closer_;
  bool found_ = false;
  PrimitivePair pair_;
};

std::optional<PrimitivePair> obb4CloserThan(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                            const Obb4TreePose& pose, double d,
                                            QueryContext& context) {
  Closer query(a, b, pose, d, context.counters);
  walkObb4(a.shape, b.shape, pose.floats.scale, kWholeTrees, *context.scratch.use<Obb4Stack>(),
           context.counters, query);
  return query.found();
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(obb4Distance);
HWY_EXPORT(obb4CloserThan);

namespace {

/// Returns true only if two triangles are at most d apart in real arithmetic. Then every search
/// returns true, so starting from the remembered pair can't change the answer. (For distances that
/// differ from d only by rounding, `CloserTriangles` may return true although this function returns
/// false.)
bool provedCloser(const Triangle& a, const Transform& X_WA, const Triangle& b,
                  const Transform& X_WB, const TriangleDistances& bounds, double d,
                  Counters& counters) {
  const PredicateResult touch = trianglesTouch(a, X_WA, b, X_WB);
  counters.addTest(touch.exact);
  return touch || bounds(a, b).upper <= d;
}

}  // namespace

Distance distance(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                  const DistanceOptions& options, QueryContext& context, LastPair* last) {
  const Obb4TreePose pose(a.shape, a.X_W, b.shape, b.X_W, HUGE_VAL);
  if (a.shape.hasParts() || b.shape.hasParts())
    return distanceWithParts(a, b, pose, options, context);
  // First, search for contact only. If the trees touch, this ends far sooner than the search below,
  // which would visit all pairs that may touch.
  if (const auto hit = touchingLeafTriangles(kWholeTrees, a, b, pose, context, last)) {
    const WitnessPoints w =
        witnessPoints(a.shape.triangle(hit->a), a.X_W, b.shape.triangle(hit->b), b.X_W);
    return {0, w.p_WA, w.p_WB, a.shape.meshTriangle(hit->a), b.shape.meshTriangle(hit->b)};
  }
  return HWY_DYNAMIC_DISPATCH(obb4Distance)(a, b, pose, options, context, last);
}

bool closerThan(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, double d, QueryContext& context,
                LastPair* last) {
  if (d == 0) return interference(a, b, context, last).has_value();
  if (std::isnan(d)) return true;  // a NaN proves nothing
  const Obb4Tree &treeA = a.shape, &treeB = b.shape;
  const Obb4TreePose pose(treeA, a.X_W, treeB, b.X_W, d);
  if (pose.apart) {
    ++context.counters.boxTests;
    return false;
  }
  if (treeA.hasParts() || treeB.hasParts()) return closerThanWithParts(a, b, pose, d, context);
  if (last && last->trusted() && last->isIn(treeA.triangleCount(), treeB.triangleCount())) {
    const bool closer =
        provedCloser(treeA.triangle(last->a), a.X_W, treeB.triangle(last->b), b.X_W,
                     {a.X_W, treeA.reach(), b.X_W, treeB.reach()}, d, context.counters);
    last->recordTest(closer);
    if (closer) return true;
  }
  const auto pair = HWY_DYNAMIC_DISPATCH(obb4CloserThan)(a, b, pose, d, context);
  if (pair && last) last->recordFound(pair->a, pair->b);
  return pair.has_value();
}

}  // namespace corridor
#endif
