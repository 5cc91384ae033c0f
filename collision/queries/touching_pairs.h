#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

#include "collision/convex/convex_contact.h"
#include "collision/core/counters.h"
#include "collision/core/posed.h"
#include "collision/hierarchy/traverse.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/relative_pose.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {

/// Returns the test of two trees' volumes under their maps.
template <class Volume, class Overlap = StandardOverlap, class TreeA, class TreeB>
PairTest<Volume, Overlap> pairTestOf(const Posed<TreeA>& a, const Posed<TreeB>& b) {
  assert(standardFloatingPoint());
  const Transform X_AB = rigidInverse(a.X_W) * b.X_W;
  return {a.shape.bounds(), b.shape.bounds(), X_AB,
          relativePoseError(a.X_W, X_AB, b.X_W, b.shape.reach())};
}

/// Returns a tree's leaf primitive, numbered in leaf order, as a convex set. The primitive is a
/// convex part or a triangle.
template <class Tree>
ConvexSet convexSetOf(const Tree& tree, std::uint32_t item) {
  if constexpr (requires { tree.part(item); })
    if (tree.hasParts()) return ConvexSet(tree.part(item));
  return ConvexSet(tree.triangles()[item]);
}

/// The query that `traverse` (hierarchy/traverse.h) runs to find touching leaf primitives of two
/// trees. Drops node pairs whose volumes are separated. Calls `found(s, t)` for each touching pair,
/// numbered in leaf order, until `found` returns true. Stops, as if there were no more pairs, once
/// the counted tests reach `workEnd`. All arguments must outlive this object.
template <class TreeA, class TreeB, class Test, class Found>
class TouchingPairs {
 public:
  using Item = NodePair;

  TouchingPairs(const Posed<TreeA>& a, const Posed<TreeB>& b, const Test& test, Counters& counters,
                const Found& found, std::uint64_t workEnd = kNoWorkLimit)
      : a_(a.shape),
        b_(b.shape),
        X_WA_(a.X_W),
        X_WB_(b.X_W),
        test_(test),
        counters_(counters),
        found_(found),
        workEnd_(workEnd) {}

  bool enter(const Item&, const typename TreeA::Node& na, const typename TreeB::Node& nb) {
    if (counters_.work() >= workEnd_) return false;
    ++counters_.boxTests;
    return !test_.separated(na.box, nb.box, 0);
  }
  bool leaves(const typename TreeA::Node& na, const typename TreeB::Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t)
        if (counters_.work() >= workEnd_ || (touch(s, t) && found_(s, t))) return true;
    return false;
  }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) { stack.push_back({i, k}); }
  void opened(std::vector<Item>& stack, std::size_t first) {  // visits the first child first
    std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
  }

  /// Tests one pair of leaf primitives, numbered in leaf order.
  bool touch(std::uint32_t s, std::uint32_t t) const {
    const PredicateResult result =
        a_.hasParts() || b_.hasParts()
            ? convexSetsTouch({convexSetOf(a_, s), X_WA_}, {convexSetOf(b_, t), X_WB_})
            : trianglesTouch(a_.triangles()[s], X_WA_, b_.triangles()[t], X_WB_);
    counters_.addTest(result.exact);
    return result;
  }

 private:
  const TreeA& a_;
  const TreeB& b_;
  const Transform &X_WA_, &X_WB_;
  const Test& test_;
  Counters& counters_;
  const Found& found_;
  const std::uint64_t workEnd_;
};

}  // namespace corridor
