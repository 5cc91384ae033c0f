#include "collision/queries/interference_wide.h"

#include <vector>

#include "collision/convex/convex_contact.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/triangle_intersection.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/queries/interference_wide.cpp"
#include "hwy/foreach_target.h"
// After foreach_target.h, as Highway asks.
#include "hwy/highway.h"

#include "collision/hierarchy/wide_walk-inl.h"
#include "collision/queries/wide_leaves-inl.h"
#include "collision/volumes/overlap_obb4_obb4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// A tree's item as a convex set; keeps the corners that the set looks at.
struct ItemSet {
  Triangle corners;
  ConvexSet set;
  ItemSet(const WideObbTree& tree, std::uint32_t item)
      : corners(tree.part() ? Triangle() : tree.triangle(item)),
        set(tree.part() ? ConvexSet(*tree.part()) : ConvexSet(corners)) {}
  ItemSet(const ItemSet&) = delete;
  ItemSet& operator=(const ItemSet&) = delete;
};

/// Pairs of triangles (or solids) that touch: boxes by floats, triangles by floats, those that are
/// left by the exact predicate. `Found(s, t)`, in leaf order, is told each, until it returns true.
template <class Found>
class Touching {
 public:
  Touching(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b, const Transform& X_WB,
           const WidePose& pose, Counters& counters, const Found& found, std::uint64_t workEnd)
      : a_(a),
        b_(b),
        X_WA_(X_WA),
        X_WB_(X_WB),
        pose_(pose),
        counters_(counters),
        leaves_(a, b, pose, counters),
        found_(found),
        workEnd_(workEnd) {}

  static constexpr bool kSorted = false;
  bool skip(const QueryContext::WideItem&) const { return counters_.work() >= workEnd_; }

  unsigned boxes(const QueryContext::WideItem&, const WideObbTree::Node& a,
                 const WideObbTree::Node& b, float* gaps) const {
    return overlappingBoxes(a, b, pose_.floats, gaps);
  }

  bool leaves(const QueryContext::WideItem&, const WideObbTree::Node& na,
              const WideObbTree::Node& nb, unsigned pairs, const float*) {
    if (a_.part() || b_.part())
      return forEachItem(na, nb, pairs, [&](unsigned, std::uint32_t s, std::uint32_t t) {
        const ItemSet setA(a_, s), setB(b_, t);
        return convexSetsTouch({setA.set, X_WA_}, {setB.set, X_WB_}, counters_) && found_(s, t);
      });
    return leaves_.forEachNear(
        na, nb, pairs, [] { return 0.0F; },
        [&](std::uint32_t s, std::uint32_t t) {
          Counters own;  // the pair is counted already
          const bool touch = trianglesTouch(a_.triangle(s), X_WA_, b_.triangle(t), X_WB_, own);
          counters_.exactTests += own.exactTests;
          return touch && found_(s, t);
        });
  }

 private:
  const WideObbTree &a_, &b_;
  const Transform &X_WA_, &X_WB_;
  const WidePose& pose_;
  Counters& counters_;
  WideLeaves leaves_;
  const Found& found_;
  std::uint64_t workEnd_;
};

std::optional<TrianglePair> firstTouching(const WideObbTree& a, const Transform& X_WA,
                                          const WideObbTree& b, const Transform& X_WB,
                                          const WidePose& pose, std::size_t count,
                                          QueryContext& context, std::uint64_t workEnd) {
  std::optional<TrianglePair> hit;
  const auto found = [&](std::uint32_t s, std::uint32_t t) {
    hit = TrianglePair{s, t};
    return true;
  };
  Touching query(a, X_WA, b, X_WB, pose, context.counters, found, workEnd);
  walkWide(a, b, pose.floats.scale, context, query, count);
  return hit;
}

std::vector<TrianglePair> allTouching(const WideObbTree& a, const Transform& X_WA,
                                      const WideObbTree& b, const Transform& X_WB,
                                      const WidePose& pose, QueryContext& context) {
  std::vector<TrianglePair> all;
  const auto found = [&](std::uint32_t s, std::uint32_t t) {
    all.push_back({s, t});
    return false;
  };
  Touching query(a, X_WA, b, X_WB, pose, context.counters, found, kNoWorkLimit);
  walkWide(a, b, pose.floats.scale, context, query);
  return all;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(firstTouching);
HWY_EXPORT(allTouching);

namespace {

/// Of the first `count` items of the stack, in leaf order.
std::optional<TrianglePair> touchingBelow(const WideObbTree& a, const Transform& X_WA,
                                          const WideObbTree& b, const Transform& X_WB,
                                          const WidePose& pose, std::size_t count,
                                          QueryContext& context, std::uint64_t workEnd) {
  LastPair& last = context.lastPairs.of(&a, &b);
  if (last.trusted() && last.isIn(a.triangleCount(), b.triangleCount())) {
    const bool touch =
        trianglesTouch(a.triangle(last.a), X_WA, b.triangle(last.b), X_WB, context.counters);
    last.tested(touch);
    if (touch) return TrianglePair{last.a, last.b};
  }
  const auto hit =
      HWY_DYNAMIC_DISPATCH(firstTouching)(a, X_WA, b, X_WB, pose, count, context, workEnd);
  if (hit) last.found(hit->a, hit->b);
  return hit;
}

}  // namespace

std::optional<TrianglePair> interference(const WideObbTree& a, const Transform& X_WA,
                                         const WideObbTree& b, const Transform& X_WB,
                                         QueryContext& context, std::uint64_t workEnd) {
  context.startAtRoots();
  return interferenceBelow(a, X_WA, b, X_WB, 1, context, workEnd);
}

std::optional<TrianglePair> interferenceBelow(const WideObbTree& a, const Transform& X_WA,
                                              const WideObbTree& b, const Transform& X_WB,
                                              std::size_t count, QueryContext& context,
                                              std::uint64_t workEnd) {
  ++context.counters.states;
  const WidePose pose(a, X_WA, b, X_WB, 0);
  if (pose.apart) {
    ++context.counters.boxTests;
    return std::nullopt;
  }
  const auto hit = touchingBelow(a, X_WA, b, X_WB, pose, count, context, workEnd);
  if (!hit) return hit;
  return TrianglePair{a.meshTriangle(hit->a), b.meshTriangle(hit->b)};
}

std::optional<TrianglePair> touchingLeafTriangles(const WideObbTree& a, const Transform& X_WA,
                                                  const WideObbTree& b, const Transform& X_WB,
                                                  const WidePose& pose, QueryContext& context,
                                                  std::uint64_t workEnd) {
  context.startAtRoots();
  return touchingBelow(a, X_WA, b, X_WB, pose, 1, context, workEnd);
}

std::vector<TriangleContact> contacts(const WideObbTree& a, const Transform& X_WA,
                                      const WideObbTree& b, const Transform& X_WB,
                                      QueryContext& context) {
  ++context.counters.states;
  std::vector<TriangleContact> found;
  const WidePose pose(a, X_WA, b, X_WB, 0);
  if (pose.apart) {
    ++context.counters.boxTests;
    return found;
  }
  for (const auto& [s, t] : HWY_DYNAMIC_DISPATCH(allTouching)(a, X_WA, b, X_WB, pose, context)) {
    const Segment segment = triangleIntersection(a.triangle(s), X_WA, b.triangle(t), X_WB);
    found.push_back({a.meshTriangle(s), b.meshTriangle(t), segment.p, segment.q});
  }
  return found;
}

}  // namespace corridor
#endif
