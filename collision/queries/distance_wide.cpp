#include "collision/queries/distance_wide.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/wide_pose.h"
#include "collision/queries/closer_triangles.h"
#include "collision/queries/interference_wide.h"
#include "collision/queries/nearest_triangles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/queries/distance_wide.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

#include "collision/hierarchy/wide_walk-inl.h"
#include "collision/queries/wide_leaves-inl.h"
#include "collision/volumes/overlap_obb4_obb4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// Metres of the world as a float of a's unit, rounded up, that distances in a's frame may have.
inline float limitOf(const WidePose& pose, double metres) {
  if (!(pose.shrink > 0)) return HUGE_VALF;
  return static_cast<float>(metres / pose.shrink * pose.unitA * (1 + 0x1p-20));
}

class Nearest {
 public:
  Nearest(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b, const Transform& X_WB,
          const WidePose& pose, const DistanceOptions& options, QueryContext& context)
      : a_(a),
        b_(b),
        pose_(pose),
        options_(options),
        counters_(context.counters),
        leaves_(a, b, pose, counters_),
        nearest_(X_WA, a.reach(), X_WB, b.reach(), options, context) {}

  static constexpr bool kSorted = true;
  bool skip(float square) const { return square > 0 && square > limit_ * limit_ * (1 + 0x1p-20F); }

  unsigned boxes(const WideObbTree::Node& a, const WideObbTree::Node& b, float* squares) const {
    return nearBoxes(a, b, pose_.floats, limit_, squares);
  }

  bool leaves(const WideObbTree::Node& na, const WideObbTree::Node& nb, unsigned pairs) {
    return leaves_.forEachNear(
        na, nb, pairs, [&] { return limit_; },
        [&](std::uint32_t s, std::uint32_t t) {
          if (nearest_.look(s, a_.triangle(s), t, b_.triangle(t), counters_)) return true;
          const double most = (nearest_.upper() - options_.absolute) / (1 + options_.relative);
          limit_ = limitOf(pose_, std::max(0.0, most));
          return false;
        });
  }

  Distance result() { return nearest_.result(a_, b_); }

 private:
  const WideObbTree &a_, &b_;
  const WidePose& pose_;
  const DistanceOptions& options_;
  Counters& counters_;
  WideLeaves leaves_;
  NearestTriangles nearest_;
  float limit_ = HUGE_VALF;  // farther than this nothing is of interest
};

Distance wideDistance(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b,
                      const Transform& X_WB, const WidePose& pose, const DistanceOptions& options,
                      QueryContext& context) {
  Nearest query(a, X_WA, b, X_WB, pose, options, context);
  walkWide(a, b, pose.floats.scale, context, query);
  return query.result();
}

class Closer {
 public:
  Closer(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b, const Transform& X_WB,
         const WidePose& pose, double d, Counters& counters)
      : a_(a),
        b_(b),
        pose_(pose),
        counters_(counters),
        leaves_(a, b, pose, counters),
        closer_(X_WA, a.reach(), X_WB, b.reach(), d),
        limit_(limitOf(pose, d)) {}

  static constexpr bool kSorted = true;
  static bool skip(float) { return false; }

  unsigned boxes(const WideObbTree::Node& a, const WideObbTree::Node& b, float* squares) const {
    return nearBoxes(a, b, pose_.floats, limit_, squares);
  }

  bool leaves(const WideObbTree::Node& na, const WideObbTree::Node& nb, unsigned pairs) {
    found_ = leaves_.forEachNear(
        na, nb, pairs, [&] { return limit_; },
        [&](std::uint32_t s, std::uint32_t t) {
          return closer_(a_.triangle(s), b_.triangle(t), counters_);
        });
    return found_;
  }

  bool found() const { return found_; }

 private:
  const WideObbTree &a_, &b_;
  const WidePose& pose_;
  Counters& counters_;
  WideLeaves leaves_;
  CloserTriangles closer_;
  float limit_;
  bool found_ = false;
};

bool wideCloser(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b,
                const Transform& X_WB, const WidePose& pose, double d, QueryContext& context) {
  Closer query(a, X_WA, b, X_WB, pose, d, context.counters);
  walkWide(a, b, pose.floats.scale, context, query);
  return query.found();
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(wideDistance);
HWY_EXPORT(wideCloser);

Distance distance(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b,
                  const Transform& X_WB, const DistanceOptions& options, QueryContext& context) {
  ++context.counters.states;
  const WidePose pose(a, X_WA, b, X_WB, HUGE_VAL);
  return HWY_DYNAMIC_DISPATCH(wideDistance)(a, X_WA, b, X_WB, pose, options, context);
}

bool closerThan(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b,
                const Transform& X_WB, double d, QueryContext& context) {
  if (d == 0) return interference(a, X_WA, b, X_WB, context).has_value();
  ++context.counters.states;
  const WidePose pose(a, X_WA, b, X_WB, d);
  if (pose.apart) {
    ++context.counters.boxTests;
    return false;
  }
  return HWY_DYNAMIC_DISPATCH(wideCloser)(a, X_WA, b, X_WB, pose, d, context);
}

}  // namespace corridor
#endif
