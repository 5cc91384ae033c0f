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

/// How the volumes of two trees are tested under two maps.
template <class Volume, class Overlap = StandardOverlap, class TreeA, class TreeB>
PairTest<Volume, Overlap> pairTestOf(const TreeA& a, const Transform& X_WA, const TreeB& b,
                                     const Transform& X_WB) {
  assert(standardFloatingPoint());
  const Transform X_AB = rigidInverse(X_WA) * X_WB;
  return {a.bounds(), b.bounds(), X_AB, relativePoseError(X_WA, X_AB, X_WB, b.reach())};
}

/// An item of a tree, in leaf order: a convex part, or a triangle, which is convex, too.
template <class Tree>
ConvexSet convexSetOf(const Tree& tree, std::uint32_t item) {
  return tree.part(item) ? ConvexSet(*tree.part(item)) : ConvexSet(tree.triangles()[item]);
}

/// What `traverse` (hierarchy/traverse.h) asks, for items of two trees that touch: a pair whose
/// volumes are apart is dropped, and `Found(s, t)`, in leaf order, is told each pair of items in
/// contact, until it returns true. Ends, as if there were no more, once the counted tests reach
/// `workEnd`.
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
  /// All of one leaf's items against all of the other's.
  bool leaves(const typename TreeA::Node& na, const typename TreeB::Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t)
        if (counters_.work() >= workEnd_ || (touch(s, t) && found_(s, t))) return true;
    return false;
  }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    stack.push_back({i, k, 0});
  }
  void opened(std::vector<Item>& stack, std::size_t first) {  // the first child first
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
