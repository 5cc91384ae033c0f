// Pairs of leaves of two wide trees, for every SIMD target: included once per target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_WIDE_LEAVES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_WIDE_LEAVES_INL_H_
#undef CORRIDOR_WIDE_LEAVES_INL_H_
#else
#define CORRIDOR_WIDE_LEAVES_INL_H_
#endif
// clang-format on

#include <bit>

#include "hwy/highway.h"

#include "collision/core/counters.h"
#include "collision/hierarchy/leaf_cache-inl.h"
#include "collision/hierarchy/wide_pose.h"
#include "collision/predicates/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// The triangles of two trees' leaves under one relative pose, filtered in float.
class WideLeaves {
 public:
  WideLeaves(const WideObbTree& a, const WideObbTree& b, const WidePose& pose, Counters& counters)
      : error_(pose.leafError),
        counters_(counters),
        leavesA_(a, Mat3::Identity() * pose.unitA, Vec3::Zero()),
        leavesB_(b, pose.m * pose.unitA, pose.t) {}

  /// Calls `near(first_a, first_b, corners_a, corners_b, open)` for each of these pairs of leaves
  /// that has pairs of triangles (`open`'s bits 4·i + j) that aren't proved to be farther apart
  /// than `pad()` (a's unit), until it returns true; returns whether it did.
  template <class Pad, class Near>
  bool forEachNearLeaf(const WideObbTree::Node& na, const WideObbTree::Node& nb, unsigned pairs,
                       Pad&& pad, Near&& near) {
    for (; pairs; pairs &= pairs - 1) {
      const auto pair = static_cast<unsigned>(std::countr_zero(pairs));
      const std::uint32_t childA = na.child[pair / 4], childB = nb.child[pair % 4];
      const std::uint32_t firstA = WideObbTree::leafFirst(childA),
                          firstB = WideObbTree::leafFirst(childB);
      const unsigned countA = WideObbTree::leafCount(childA),
                     countB = WideObbTree::leafCount(childB);
      counters_.triangleTests += countA * countB;
      unsigned wanted = 0;
      for (unsigned s = 0; s < countA; ++s) wanted |= ((1U << countB) - 1) << 4 * s;
      const LeafCorners &a = leavesA_.get(childA), &b = leavesB_.get(childB);
      const unsigned open = touchingTriangles(a, b, error_, pad()) & wanted;
      if (open && near(firstA, firstB, a, b, open)) return true;
    }
    return false;
  }
  /// The same with `found(s, t)` for each pair of triangles, in leaf order.
  template <class Pad, class Found>
  bool forEachNear(const WideObbTree::Node& na, const WideObbTree::Node& nb, unsigned pairs,
                   Pad&& pad, Found&& found) {
    return forEachNearLeaf(na, nb, pairs, pad,
                           [&](std::uint32_t firstA, std::uint32_t firstB, const LeafCorners&,
                               const LeafCorners&, unsigned open) {
                             for (; open; open &= open - 1) {
                               const auto bit = static_cast<unsigned>(std::countr_zero(open));
                               if (found(firstA + bit / 4, firstB + bit % 4)) return true;
                             }
                             return false;
                           });
  }

 private:
  float error_;
  Counters& counters_;
  LeafCache leavesA_, leavesB_;
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
