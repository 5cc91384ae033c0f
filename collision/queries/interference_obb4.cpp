#include "collision/queries/interference_obb4.h"

#include <stdexcept>
#include <vector>

#include "collision/convex/convex_contact.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/obb4_leaf_set.h"
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

/// The query for touching pairs. Node pairs and pairs of triangles are filtered in float; the exact
/// predicate decides the triangles that remain, `convexSetsTouch` decides convex parts. Calls
/// `found(s, t)` for each touching pair, numbered in leaf order, until `found` returns true. All
/// arguments must outlive this object.
template <class Found>
class Touching {
 public:
  Touching(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, const Obb4TreePose& pose,
           Counters& counters, const Found& found, std::uint64_t workEnd)
      : a_(a.shape),
        b_(b.shape),
        X_WA_(a.X_W),
        X_WB_(b.X_W),
        pose_(pose),
        counters_(counters),
        leaves_(a_, b_, pose, counters),
        found_(found),
        workEnd_(workEnd) {}

  static constexpr bool kSorted = false;
  bool skip(const NodePair4&) const { return counters_.work() >= workEnd_; }

  unsigned boxes(const NodePair4&, const Obb4Tree::Node& a, const Obb4Tree::Node& b,
                 float* gaps) const {
    return overlappingBoxes(a, b, pose_.floats, gaps);
  }

  bool leaves(const NodePair4&, const Obb4Tree::Node& na, const Obb4Tree::Node& nb, unsigned pairs,
              const float*) {
    if (a_.hasParts() || b_.hasParts())
      return forEachLeafPrimitivePair(
          na, nb, pairs, [&](unsigned, std::uint32_t s, std::uint32_t t) {
            const Obb4LeafSet setA(a_, s), setB(b_, t);
            const PredicateResult touch = convexSetsTouch({setA.set(), X_WA_}, {setB.set(), X_WB_});
            counters_.addTest(touch.exact);
            return touch && found_(s, t);
          });
    return leaves_.forEachNear(
        na, nb, pairs, [] { return 0.0F; },
        [&](std::uint32_t s, std::uint32_t t) {
          const PredicateResult touch =
              trianglesTouch(a_.triangle(s), X_WA_, b_.triangle(t), X_WB_);
          counters_.exactTests += touch.exact;  // the filter has already counted the pair
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

std::optional<PrimitivePair> firstTouching(std::span<const NodePair4> start,
                                           const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                           const Obb4TreePose& pose, QueryContext& context,
                                           std::uint64_t workEnd) {
  std::optional<PrimitivePair> hit;
  const auto found = [&](std::uint32_t s, std::uint32_t t) {
    hit = PrimitivePair{s, t};
    return true;
  };
  Touching query(a, b, pose, context.counters, found, workEnd);
  walkObb4(a.shape, b.shape, pose.floats.scale, start, *context.scratch.use<Obb4Stack>(),
           context.counters, query);
  return hit;
}

std::vector<PrimitivePair> allTouching(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                       const Obb4TreePose& pose, QueryContext& context) {
  std::vector<PrimitivePair> all;
  const auto found = [&](std::uint32_t s, std::uint32_t t) {
    all.push_back({s, t});
    return false;
  };
  Touching query(a, b, pose, context.counters, found, kNoWorkLimit);
  walkObb4(a.shape, b.shape, pose.floats.scale, kWholeTrees, *context.scratch.use<Obb4Stack>(),
           context.counters, query);
  return all;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(firstTouching);
HWY_EXPORT(allTouching);

std::optional<PrimitivePair> touchingLeafTriangles(std::span<const NodePair4> start,
                                                   const Posed<Obb4Tree>& a,
                                                   const Posed<Obb4Tree>& b,
                                                   const Obb4TreePose& pose, QueryContext& context,
                                                   LastPair* last, std::uint64_t workEnd) {
  const Obb4Tree &treeA = a.shape, &treeB = b.shape;
  if (last && last->trusted() && last->isIn(treeA.triangleCount(), treeB.triangleCount())) {
    const PredicateResult touch =
        trianglesTouch(treeA.triangle(last->a), a.X_W, treeB.triangle(last->b), b.X_W);
    context.counters.addTest(touch.exact);
    last->recordTest(touch);
    if (touch) return PrimitivePair{last->a, last->b};
  }
  const auto hit = HWY_DYNAMIC_DISPATCH(firstTouching)(start, a, b, pose, context, workEnd);
  if (hit && last) last->recordFound(hit->a, hit->b);
  return hit;
}

std::optional<PrimitivePair> interference(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                          QueryContext& context, LastPair* last,
                                          std::uint64_t workEnd) {
  return interferenceBelow(kWholeTrees, a, b, context, last, workEnd);
}

std::optional<PrimitivePair> interferenceBelow(std::span<const NodePair4> start,
                                               const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                               QueryContext& context, LastPair* last,
                                               std::uint64_t workEnd) {
  const Obb4TreePose pose(a.shape, a.X_W, b.shape, b.X_W, 0);
  if (pose.apart) {
    ++context.counters.boxTests;
    return std::nullopt;
  }
  const auto hit = touchingLeafTriangles(start, a, b, pose, context, last, workEnd);
  if (!hit) return hit;
  return PrimitivePair{a.shape.meshTriangle(hit->a), b.shape.meshTriangle(hit->b)};
}

std::vector<TriangleContact> contacts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                      QueryContext& context) {
  if (!a.X_W.isFinite() || !b.X_W.isFinite())
    throw std::invalid_argument("contacts: the maps must be finite");
  std::vector<TriangleContact> found;
  const Obb4TreePose pose(a.shape, a.X_W, b.shape, b.X_W, 0);
  if (pose.apart) {
    ++context.counters.boxTests;
    return found;
  }
  for (const auto& [s, t] : HWY_DYNAMIC_DISPATCH(allTouching)(a, b, pose, context)) {
    const Segment segment =
        triangleIntersection(a.shape.triangle(s), a.X_W, b.shape.triangle(t), b.X_W);
    found.push_back({a.shape.meshTriangle(s), b.shape.meshTriangle(t), segment.p, segment.q});
  }
  return found;
}

}  // namespace corridor
#endif
