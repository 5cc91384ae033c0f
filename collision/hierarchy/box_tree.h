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
  /// The sum of the magnitudes of all six bounds, or more, metres. Differences of coordinates and
  /// these bounds have rounding errors. The part of the errors that the bounds cause is at most
  /// proportional to this sum.
  double terms = 0;
};

/// A binary tree of boxes, for the broad phase: it finds the boxes near a body without a test of
/// each box. A leaf is one of the given boxes. Boxes are split by the surface-area heuristic
/// (Goldsmith and Salmon 1987; in bins, as Wald 2007 does). Boxes that are far from all others are
/// therefore split off at nodes near the root, where a walk can exclude them early. The depth is at
/// most `kMaxDepth`.
///
/// If a body moves, comes or goes, one call of `refit`, `insert` or `remove` adapts the tree. The
/// time of a call is proportional to the tree's depth, except for rare insertions that build the
/// tree again (Catto's dynamic tree in Box2D is similar). If an insertion makes the tree far deeper
/// than a balanced one, the tree is balanced by rotations. With a fixed `within`, the items that
/// `walk` finds do not depend on the tree's history, but the cost of `walk` does. After many bodies
/// have moved far, call `rebuild`, so that walks are fast again.
class BoxTree {
 public:
  BoxTree() = default;  ///< no items
  /// Builds the tree. Box number k is item k. Takes O(n log n) time.
  /// @throws std::invalid_argument if there are 2^31 boxes or more, or a bound is not a number.
  explicit BoxTree(std::span<const BoundingBox> boxes);

  std::size_t size() const { return size_; }  ///< number of items
  bool contains(std::size_t item) const { return item < leaves_.size() && leaves_[item] != kNone; }

  /// Adds an item. The tree's memory is proportional to the largest item number.
  /// @throws std::invalid_argument if the tree contains the item, its number is 2^31 or more, or a
  /// bound of the box is not a number.
  void insert(std::size_t item, const BoundingBox& box);
  /// Removes an item. @throws std::invalid_argument if the tree does not contain the item.
  void remove(std::size_t item);
  /// Replaces the box of an item, and adapts the boxes around it.
  /// @throws std::invalid_argument if the tree does not contain the item, or a bound of the box is
  /// not a number.
  void refit(std::size_t item, const BoundingBox& box);
  /// Builds the tree of the same items again.
  void rebuild();

  /// Returns the number of levels below the root; 0 without items.
  std::size_t height() const { return root_ == kNone ? 0 : links_[root_].height; }
  /// Returns whether the tree is sound: each inner box contains its children's boxes, the depth is
  /// within its limit, and each item is one leaf.
  bool check() const;

  /// Calls visit(item) for each item for which all boxes from the root to its leaf satisfy
  /// bound(box) ≤ within. The child with the lower bound is visited first. Stops if `visit` returns
  /// true.
  /// @param bound returns a lower bound of the distance from a box, metres
  /// @param within may be lowered by `visit`
  /// @returns whether `visit` stopped the walk.
  template <class Bound, class Visit>
  bool walk(const Bound& bound, const double& within, const Visit& visit) const {
    if (root_ == kNone) return false;
    struct Open {
      std::uint32_t node;
      double bound;
    };
    std::array<Open, kMaxDepth + 1> open;  // one sibling per level, and the node itself
    std::size_t count = 0;
    open[count++] = {root_, bound(nodes_[root_].box)};
    while (count > 0) {
      const Open next = open[--count];
      if (next.bound > within) continue;
      const Node& node = nodes_[next.node];
      if (node.isLeaf()) {
        if (visit(std::size_t{node.left})) return true;
        continue;
      }
      const Open left{node.left, bound(nodes_[node.left].box)},
          right{node.right, bound(nodes_[node.right].box)};
      const bool leftFirst = left.bound <= right.bound;
      open[count++] = leftFirst ? right : left;
      open[count++] = leftFirst ? left : right;
    }
    return false;
  }

 private:
  /// A tree of 2^31 items that is halved at the median has 31 levels. The other levels allow
  /// unequal halves.
  static constexpr std::size_t kMaxDepth = 48;

  static constexpr std::uint32_t kNone = 0xffffffff;

  /// 64 bytes, so that a walk reads one cache line per node.
  struct Node {
    BoundingBox box;
    std::uint32_t left = kNone, right = kNone;  ///< the children; in a leaf: the item, and kNone
    bool isLeaf() const { return right == kNone; }
  };
  /// Data of a node that `walk` does not need, but changes of the tree need.
  struct Link {
    std::uint32_t parent = kNone;
    std::uint32_t height = 0;  ///< levels below the node
  };

  std::uint32_t add(const BoundingBox& box, std::uint32_t left, std::uint32_t right);
  std::uint32_t leafOf(std::size_t item) const;
  /// Returns a node beside which a new leaf with this box adds little surface area to the tree. The
  /// search is greedy: it descends into the cheaper child as long as descending costs less than
  /// stopping.
  std::uint32_t siblingFor(const BoundingBox& box) const;
  void setChild(std::uint32_t parent, std::uint32_t before, std::uint32_t after);
  /// Fits a node and all nodes above it to their children.
  void fitUpwards(std::uint32_t node);
  /// The same as `fitUpwards`, but also rotates each of these nodes whose children's heights differ
  /// by more than 1.
  void rotateUpwards(std::uint32_t node);
  void fit(std::uint32_t node);

  /// @param depth the depth that is counted for the root. The larger it is, the fewer levels the
  /// tree may get.
  void rebuild(std::size_t depth);
  /// @param numbers the numbers of the items, in the order of the boxes.
  void build(std::span<const BoundingBox> boxes, std::span<const std::uint32_t> numbers,
             std::size_t depth);
  /// @param order the boxes of this node, by their indices in `boxes`. The function reorders it.
  std::uint32_t buildNode(std::span<const BoundingBox> boxes,
                          std::span<const std::uint32_t> numbers, std::span<std::uint32_t> order,
                          std::size_t depth);
  /// Reorders the items so that those of the left child come first. Returns the number of items of
  /// the left child. Both children get at least one item.
  /// @param all  the box around all items.
  /// @param low, high the least and the largest coordinates of twice the items' centres.
  static std::size_t split(std::span<const BoundingBox> boxes, std::span<std::uint32_t> items,
                           const BoundingBox& all, const Vec3& low, const Vec3& high,
                           std::size_t depth);

  std::vector<Node> nodes_;
  std::vector<Link> links_;            // for each node
  std::vector<std::uint32_t> leaves_;  // for each item, its node; kNone: not contained
  std::vector<std::uint32_t> unused_;  // nodes that were removed
  std::uint32_t root_ = kNone;
  std::size_t size_ = 0;
};

}  // namespace corridor
