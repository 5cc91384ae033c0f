#include "collision/queries/interference_obb4.h"

#include <vector>

#include "collision/convex/convex_contact.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/triangle_intersection.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/queries/interference_obb4.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/hierarchy/obb4_walk-inl.h"
#include "collision/queries/obb4_leaves-inl.h"
#include "collision/volumes/overlap_obb4_obb4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// A tree's leaf primitive as a convex set, and the corners that the set refers to.
struct ItemSet {
  Triangle corners;
  ConvexSet set;
  ItemSet(const Obb4Tree& tree, std::uint32_t item)
      : corners(tree.part() ? Triangle() : tree.triangle(item)),
        set(tree.part() ? ConvexSet(*tree.part()) : ConvexSet(corners)) {}
  ItemSet(const ItemSet&) = delete;
  ItemSet& operator=(const ItemSet&) = delete;
};

/// The query for touching pairs. Node pairs and pairs of triangles are filtered in float; the exact
/// predicate decides the triangles that remain, `convexSetsTouch` decides convex parts. Calls
/// `Found(s, t)`, numbered in leaf order, for each touching pair until it returns true.
template <class Found>
class Touching {
 public:
  Touching(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b, const Transform& X_WB,
           const Obb4TreePose& pose, Counters& counters, const Found& found, std::uint64_t workEnd)
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
  bool skip(const QueryContext::NodePair4&) const { return counters_.work() >= workEnd_; }

  unsigned boxes(const QueryContext::NodePair4&, const Obb4Tree::Node& a, const Obb4Tree::Node& b,
                 float* gaps) const {
    return overlappingBoxes(a, b, pose_.floats, gaps);
  }

  bool leaves(const QueryContext::NodePair4&, const Obb4Tree::Node& na, const Obb4Tree::Node& nb,
              unsigned pairs, const float*) {
    if (a_.part() || b_.part())
      return forEachItem(na, nb, pairs, [&](unsigned, std::uint32_t s, std::uint32_t t) {
        const ItemSet setA(a_, s), setB(b_, t);
        return convexSetsTouch({setA.set, X_WA_}, {setB.set, X_WB_}, counters_) && found_(s, t);
      });
    return leaves_.forEachNear(
        na, nb, pairs, [] { return 0.0F; },
        [&](std::uint32_t s, std::uint32_t t) {
          Counters own;  // the filter has already counted this pair
          const bool touch = trianglesTouch(a_.triangle(s), X_WA_, b_.triangle(t), X_WB_, own);
          counters_.exactTests += own.exactTests;
          return touch && found_(s, t);
        });
  }

 private:
  const Obb4Tree &a_, &b_;
  const Transform &X_WA_, &X_WB_;
  const Obb4TreePose& pose_;
  Counters& counters_;
  Obb4Leaves leaves_;
  const Found& found_;
  std::uint64_t workEnd_;
};

std::optional<TrianglePair> firstTouching(const Obb4Tree& a, const Transform& X_WA,
                                          const Obb4Tree& b, const Transform& X_WB,
                                          const Obb4TreePose& pose, std::size_t count,
                                          QueryContext& context, std::uint64_t workEnd) {
  std::optional<TrianglePair> hit;
  const auto found = [&](std::uint32_t s, std::uint32_t t) {
    hit = TrianglePair{s, t};
    return true;
  };
  Touching query(a, X_WA, b, X_WB, pose, context.counters, found, workEnd);
  walkObb4(a, b, pose.floats.scale, context, query, count);
  return hit;
}

std::vector<TrianglePair> allTouching(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b,
                                      const Transform& X_WB, const Obb4TreePose& pose,
                                      QueryContext& context) {
  std::vector<TrianglePair> all;
  const auto found = [&](std::uint32_t s, std::uint32_t t) {
    all.push_back({s, t});
    return false;
  };
  Touching query(a, X_WA, b, X_WB, pose, context.counters, found, kNoWorkLimit);
  walkObb4(a, b, pose.floats.scale, context, query);
  return all;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(firstTouching);
HWY_EXPORT(allTouching);

namespace {

/// Returns the first touching pair found below the first `count` entries of `context.stack4`,
/// numbered in leaf order. Tests the remembered pair first, if it is trusted.
std::optional<TrianglePair> touchingBelow(const Obb4Tree& a, const Transform& X_WA,
                                          const Obb4Tree& b, const Transform& X_WB,
                                          const Obb4TreePose& pose, std::size_t count,
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

std::optional<TrianglePair> interference(const Obb4Tree& a, const Transform& X_WA,
                                         const Obb4Tree& b, const Transform& X_WB,
                                         QueryContext& context, std::uint64_t workEnd) {
  context.startAtRoots();
  return interferenceBelow(a, X_WA, b, X_WB, 1, context, workEnd);
}

std::optional<TrianglePair> interferenceBelow(const Obb4Tree& a, const Transform& X_WA,
                                              const Obb4Tree& b, const Transform& X_WB,
                                              std::size_t count, QueryContext& context,
                                              std::uint64_t workEnd) {
  ++context.counters.states;
  const Obb4TreePose pose(a, X_WA, b, X_WB, 0);
  if (pose.apart) {
    ++context.counters.boxTests;
    return std::nullopt;
  }
  const auto hit = touchingBelow(a, X_WA, b, X_WB, pose, count, context, workEnd);
  if (!hit) return hit;
  return TrianglePair{a.meshTriangle(hit->a), b.meshTriangle(hit->b)};
}

std::optional<TrianglePair> touchingLeafTriangles(const Obb4Tree& a, const Transform& X_WA,
                                                  const Obb4Tree& b, const Transform& X_WB,
                                                  const Obb4TreePose& pose, QueryContext& context,
                                                  std::uint64_t workEnd) {
  context.startAtRoots();
  return touchingBelow(a, X_WA, b, X_WB, pose, 1, context, workEnd);
}

std::vector<TriangleContact> contacts(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b,
                                      const Transform& X_WB, QueryContext& context) {
  ++context.counters.states;
  std::vector<TriangleContact> found;
  const Obb4TreePose pose(a, X_WA, b, X_WB, 0);
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
