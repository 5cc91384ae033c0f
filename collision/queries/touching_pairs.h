#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

#include "collision/convex/convex_contact.h"
#include "collision/core/query_context.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/relative_pose.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {

/// Returns the test of two trees' volumes under two maps.
template <class Volume, class Overlap = StandardOverlap, class TreeA, class TreeB>
PairTest<Volume, Overlap> pairTestOf(const TreeA& a, const Transform& X_WA, const TreeB& b,
                                     const Transform& X_WB) {
  assert(standardFloatingPoint());
  const Transform X_AB = rigidInverse(X_WA) * X_WB;
  return {a.bounds(), b.bounds(), X_AB, relativePoseError(X_WA, X_AB, X_WB, b.reach())};
}

/// Returns a tree's leaf primitive, numbered in leaf order, as a convex set. It is a convex part,
/// or a triangle, which is convex, too.
template <class Tree>
ConvexSet convexSetOf(const Tree& tree, std::uint32_t item) {
  return tree.part(item) ? ConvexSet(*tree.part(item)) : ConvexSet(tree.triangles()[item]);
}

/// The query that `traverse` (hierarchy/traverse.h) runs to find touching leaf primitives of two
/// trees. It drops node pairs whose volumes are separated, and calls `Found(s, t)`, numbered in
/// leaf order, for each touching pair until that returns true. It ends, as if there were no more
/// pairs, once the counted tests reach `workEnd`.
template <class TreeA, class TreeB, class Test, class Found>
class TouchingPairs {
 public:
  using Item = QueryContext::NodePair;

  TouchingPairs(const TreeA& a, const Transform& X_WA, const TreeB& b, const Transform& X_WB,
                const Test& test, Counters& counters, const Found& found,
                std::uint64_t workEnd = kNoWorkLimit)
      : a_(a),
        b_(b),
        X_WA_(X_WA),
        X_WB_(X_WB),
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
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    stack.push_back({i, k, 0});
  }
  void opened(std::vector<Item>& stack, std::size_t first) {  // visit the first child first
    std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
  }

 private:
  bool touch(std::uint32_t s, std::uint32_t t) const {
    if (a_.part() || b_.part())
      return convexSetsTouch({convexSetOf(a_, s), X_WA_}, {convexSetOf(b_, t), X_WB_}, counters_);
    return trianglesTouch(a_.triangles()[s], X_WA_, b_.triangles()[t], X_WB_, counters_);
  }

  const TreeA& a_;
  const TreeB& b_;
  const Transform &X_WA_, &X_WB_;
  const Test& test_;
  Counters& counters_;
  const Found& found_;
  const std::uint64_t workEnd_;
};

}  // namespace corridor
