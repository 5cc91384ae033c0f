#include "collision/queries/distance_obb4_parts.h"

#include <algorithm>
#include <cmath>

#include "collision/queries/nearest_parts.h"
#include "collision/queries/obb4_leaf_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/queries/distance_obb4_parts.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/hierarchy/obb4_walk-inl.h"
#include "collision/queries/obb4_leaves-inl.h"
#include "collision/volumes/overlap_obb4_obb4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// The distance query on two 4-wide OBB trees of which at least one holds convex parts. Filters
/// boxes in float; `NearestParts` measures the leaf primitives.
class NearestWithParts {
 public:
  NearestWithParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
                   const DistanceOptions& options, QueryContext& context)
      : a_(a.shape),
        b_(b.shape),
        pose_(pose),
        options_(options),
        counters_(context.counters),
        nearest_(a.X_W, a_.reach(), b.X_W, b_.reach(), options, context),
        limit_(pose.inUnitsOfA(options.upTo)) {}

  static constexpr bool kSorted = true;
  bool skip(const NodePair4& item) const { return isBeyond(item.key, limit_); }

  unsigned boxes(const NodePair4&, const Obb4Tree::Node& a, const Obb4Tree::Node& b,
                 float* squares) const {
    return nearBoxes<true>(a, b, pose_.floats, limit_, squares);
  }

  bool leaves(const NodePair4&, const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned pairs,
              const float* keys) {
    while (pairs) {
      const unsigned nearest = leastOf(pairs, keys);
      if (isBeyond(keys[nearest], limit_)) return false;
      pairs &= ~(1U << nearest);
      if (forEachLeafPrimitivePair(
              na, nb, 1U << nearest,
              [&](unsigned, std::uint32_t s, std::uint32_t t) { return look(s, t); }))
        return true;
    }
    return false;
  }

  Distance result() { return nearest_.result(a_, b_); }

 private:
  bool look(std::uint32_t s, std::uint32_t t) {
    ++counters_.triangleTests;
    const Obb4LeafSet setA(a_, s), setB(b_, t);
    if (nearest_.look(s, setA.set(), t, setB.set(), counters_)) return true;
    const double most = (nearest_.upper() - options_.absolute) / (1 + options_.relative);
    limit_ = std::min(limit_, pose_.inUnitsOfA(std::max(0.0, most)));
    return false;
  }

  const Obb4Tree &a_, &b_;
  const Obb4TreePose& pose_;
  const DistanceOptions& options_;
  Counters& counters_;
  NearestParts nearest_;
  float limit_;  // in a's unit: pairs that are farther apart are skipped
};

Distance distanceOfParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                         const Obb4TreePose& pose, const DistanceOptions& options,
                         QueryContext& context) {
  NearestWithParts query(a, b, pose, options, context);
  walkObb4(a.shape, b.shape, pose.floats.scale, kWholeTrees, context.scratch.of<Obb4Stack>(),
           context.counters, query);
  return query.result();
}

/// The tolerance query on two 4-wide OBB trees of which at least one holds convex parts.
class CloserWithParts {
 public:
  CloserWithParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
                  double d, Counters& counters)
      : a_(a.shape),
        b_(b.shape),
        pose_(pose),
        counters_(counters),
        closer_(a.X_W, a_.reach(), b.X_W, b_.reach(), d),
        limit_(pose.inUnitsOfA(d)) {}

  static constexpr bool kSorted = true;
  static bool skip(const NodePair4&) { return false; }

  unsigned boxes(const NodePair4&, const Obb4Tree::Node& a, const Obb4Tree::Node& b,
                 float* squares) const {
    return nearBoxes<false>(a, b, pose_.floats, limit_, squares);
  }

  bool leaves(const NodePair4&, const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned pairs,
              const float*) {
    found_ =
        forEachLeafPrimitivePair(na, nb, pairs, [&](unsigned, std::uint32_t s, std::uint32_t t) {
          ++counters_.triangleTests;
          const Obb4LeafSet setA(a_, s), setB(b_, t);
          return closer_(setA.set(), setB.set(), counters_);
        });
    return found_;
  }

  bool found() const { return found_; }

 private:
  const Obb4Tree &a_, &b_;
  const Obb4TreePose& pose_;
  Counters& counters_;
  CloserParts closer_;
  float limit_;
  bool found_ = false;
};

bool partsCloserThan(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
                     double d, QueryContext& context) {
  CloserWithParts query(a, b, pose, d, context.counters);
  walkObb4(a.shape, b.shape, pose.floats.scale, kWholeTrees, context.scratch.of<Obb4Stack>(),
           context.counters, query);
  return query.found();
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(distanceOfParts);
HWY_EXPORT(partsCloserThan);

Distance distanceWithParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                           const Obb4TreePose& pose, const DistanceOptions& options,
                           QueryContext& context) {
  return HWY_DYNAMIC_DISPATCH(distanceOfParts)(a, b, pose, options, context);
}

bool closerThanWithParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                         const Obb4TreePose& pose, double d, QueryContext& context) {
  return HWY_DYNAMIC_DISPATCH(partsCloserThan)(a, b, pose, d, context);
}

}  // namespace corridor
#endif
