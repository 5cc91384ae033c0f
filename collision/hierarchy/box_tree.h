#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// An axis-aligned box around a body, metres. Initially it is empty.
struct BoundingBox {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  /// The sum of the magnitudes of all bounds, or more. The rounding of differences with the bounds
  /// is proportional to it.
  double terms = 0;
};

/// A binary tree of boxes, for the broad phase: it finds the boxes near a body without a test of
/// each box. A leaf is one of the given boxes. Boxes are split by the surface-area heuristic
/// (Goldsmith and Salmon 1987; in bins, as Wald 2007 does), so that a group of boxes far from all
/// others is passed over near the root. The depth is at most `kMaxDepth`.
class BoxTree {
 public:
  /// Builds the tree. Box number k is item k. Takes O(n log n) time.
  explicit BoxTree(std::span<const BoundingBox> boxes);

  /// Calls visit(item) for each item whose boxes, from the root to the leaf, satisfy bound(box) ≤
  /// within. The child with the lower bound is visited first. Stops if `visit` returns true.
  /// @param bound returns a lower bound of the distance from a box, metres
  /// @param within may be lowered by `visit`
  /// @returns whether `visit` stopped the walk.
  template <class Bound, class Visit>
  bool walk(const Bound& bound, const double& within, const Visit& visit) const {
    if (nodes_.empty()) return false;
    struct Open {
      std::uint32_t node;
      double bound;
    };
    std::array<Open, kMaxDepth + 1> open;  // one sibling per level, and the node itself
    std::size_t count = 0;
    open[count++] = {0, bound(nodes_[0].box)};
    while (count > 0) {
      const Open next = open[--count];
      if (next.bound > within) continue;
      const Node& node = nodes_[next.node];
      if (node.right == 0) {
        if (visit(std::size_t{node.item})) return true;
        continue;
      }
      const Open left{next.node + 1, bound(nodes_[next.node + 1].box)},
          right{node.right, bound(nodes_[node.right].box)};
      const bool leftFirst = left.bound <= right.bound;
      open[count++] = leftFirst ? right : left;
      open[count++] = leftFirst ? left : right;
    }
    return false;
  }

 private:
  /// A tree of 2^31 items that is halved at the median has 31 levels. The others are for unequal
  /// halves.
  static constexpr std::size_t kMaxDepth = 48;

  struct Node {
    BoundingBox box;
    std::uint32_t right = 0;  ///< the left child follows its parent; 0: a leaf
    std::uint32_t item = 0;   ///< leaves only
  };

  std::uint32_t build(std::span<const BoundingBox> boxes, std::span<std::uint32_t> items,
                      std::size_t depth);
  /// Sorts the items so that those of the left child come first, and returns their number. Both
  /// children get at least one item.
  /// @param all  the box around all items.
  /// @param low, high  the bounds of twice the centres of the items.
  static std::size_t split(std::span<const BoundingBox> boxes, std::span<std::uint32_t> items,
                           const BoundingBox& all, const Vec3& low, const Vec3& high,
                           std::size_t depth);

  std::vector<Node> nodes_;
};

}  // namespace corridor
