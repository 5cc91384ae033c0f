#include "collision/queries/distance_obb4_parts.h"

#include "collision/queries/nearest_parts.h"
#include "collision/queries/obb4_leaf_set.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/queries/distance_obb4_parts.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/hierarchy/obb4_walk-inl.h"
#include "collision/queries/boxes_within-inl.h"
#include "collision/queries/obb4_leaves-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// The distance query on two 4-wide OBB trees of which at least one holds convex parts. Filters
/// boxes in float; `NearestParts` measures the leaf primitives.
class NearestWithParts : public BoxesWithin<true> {
 public:
  NearestWithParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
                   const DistanceOptions& options, QueryContext& context)
      : BoxesWithin(a, b, pose, options.upTo, context.counters),
        options_(options),
        nearest_(a.X_W, a_.reach(), b.X_W, b_.reach(), options, context) {}

  bool leaves(const NodePair4&, const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned pairs,
              const float* keys) {
    while (pairs) {
      const unsigned nearest = leastOf(pairs, keys);
      if (isBeyond(keys[nearest])) return false;
      pairs &= ~(1U << nearest);
      if (forEachLeafPrimitivePair(
              na, nb, 1U << nearest,
              [&](unsigned, std::uint32_t s, std::uint32_t t) { return testPair(s, t); }))
        return true;
    }
    return false;
  }

  Distance result() { return nearest_.result(a_, b_); }
  void takeAsApart() { nearest_.takeAsApart(); }
  bool isDenied() { return nearest_.isDenied(a_, b_); }

 private:
  bool testPair(std::uint32_t s, std::uint32_t t) {
    ++counters_.primitiveTests;
    const Obb4LeafSet setA(a_, s), setB(b_, t);
    if (nearest_.testPair(s, setA.set(), t, setB.set(), counters_)) return true;
    reduceLimit(nearest_.upper(), options_);
    return false;
  }

  const DistanceOptions& options_;
  NearestParts nearest_;
};

Distance distanceOfParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                         const Obb4TreePose& pose, const DistanceOptions& options,
                         QueryContext& context) {
  const auto search = [&](NearestWithParts& query) {
    walkObb4(a.shape, b.shape, pose.floats.scale, kWholeTrees, *context.scratch.use<Obb4Stack>(),
             context.counters, query);
  };
  {
    NearestWithParts query(a, b, pose, options, context);
    search(query);
    if (!query.isDenied()) return query.result();
  }
  NearestWithParts again(a, b, pose, options, context);
  again.takeAsApart();
  search(again);
  return again.result();
}

/// The tolerance query on two 4-wide OBB trees of which at least one holds convex parts.
class CloserWithParts : public BoxesWithin<false> {
 public:
  CloserWithParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
                  double d, Counters& counters)
      : BoxesWithin(a, b, pose, d, counters), closer_(a.X_W, a_.reach(), b.X_W, b_.reach(), d) {}

  static bool skip(const NodePair4&) { return false; }  // since the limit never shrinks

  bool leaves(const NodePair4&, const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned pairs,
              const float*) {
    found_ =
        forEachLeafPrimitivePair(na, nb, pairs, [&](unsigned, std::uint32_t s, std::uint32_t t) {
          ++counters_.primitiveTests;
          const Obb4LeafSet setA(a_, s), setB(b_, t);
          return closer_(setA.set(), setB.set(), counters_);
        });
    return found_;
  }

  bool found() const { return found_; }

 private:
  CloserParts closer_;
  bool found_ = false;
};

bool partsCloserThan(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
                     double d, QueryContext& context) {
  CloserWithParts query(a, b, pose, d, context.counters);
  walkObb4(a.shape, b.shape, pose.floats.scale, kWholeTrees, *context.scratch.use<Obb4Stack>(),
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
