#include "collision/hierarchy/box_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace corridor {
namespace {

/// All item numbers are below this limit.
constexpr std::size_t kItems = std::size_t{1} << 31;

/// @throws std::invalid_argument if a bound is not a number. A lower bound of the distance from
/// such a box would mean nothing, and a walk could miss the box.
void requireNumbers(const BoundingBox& box) {
  if (box.lower.hasNaN() || box.upper.hasNaN())
    throw std::invalid_argument("the bounds of a box must be numbers");
}

/// Number of bins per axis in which the surface-area heuristic counts boxes.
constexpr int kBins = 16;

void extend(BoundingBox& box, const BoundingBox& other) {
  box.lower = box.lower.cwiseMin(other.lower);
  box.upper = box.upper.cwiseMax(other.upper);
  box.terms = std::max(box.terms, other.terms);
}

Vec3 twiceCentre(const BoundingBox& box) {
  return box.lower + box.upper;
}

double area(const BoundingBox& box) {
  const Vec3 d = box.upper - box.lower;
  return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

/// Bins along one axis, for boxes whose centres, times 2, are between `low` and `high`.
struct Bins {
  Eigen::Index axis = 0;
  double low = 0, high = 0;

  int of(const BoundingBox& box) const {
    const double place = (box.lower[axis] + box.upper[axis] - low) / (high - low);
    if (!(place > 0)) return 0;  // also if the box is infinite, and its centre not a number
    return place < 1 ? static_cast<int>(kBins * place) : kBins - 1;
  }
};

struct Split {
  Bins bins;
  int last = 0;  ///< the last bin of the left child
  double cost = std::numeric_limits<double>::infinity();
};

/// Returns the split of the items between two bins of this axis that has the least cost. The cost
/// is that of the surface-area heuristic. Up to a factor that is the same for all splits, it is the
/// expected number of boxes that a walk tests if the probability of reaching a child is
/// proportional to the child's surface. The cost is infinite if there is no split.
Split bestSplit(std::span<const BoundingBox> boxes, std::span<const std::uint32_t> items,
                const Bins& bins) {
  struct Bin {
    BoundingBox box;
    std::size_t count = 0;
  };
  std::array<Bin, kBins> bin;
  for (const std::uint32_t item : items) {
    Bin& own = bin[static_cast<std::size_t>(bins.of(boxes[item]))];
    extend(own.box, boxes[item]);
    ++own.count;
  }
  std::array<double, kBins> right{};  // cost of the bins from this one on
  Bin sum;
  for (std::size_t i = kBins; i-- > 1;) {
    if (bin[i].count > 0) extend(sum.box, bin[i].box);
    sum.count += bin[i].count;
    right[i] = sum.count > 0 ? static_cast<double>(sum.count) * area(sum.box) : HUGE_VAL;
  }
  Split best{bins};
  sum = {};
  for (std::size_t i = 0; i + 1 < kBins; ++i) {
    if (bin[i].count > 0) extend(sum.box, bin[i].box);
    sum.count += bin[i].count;
    if (sum.count == 0) continue;
    const double cost = static_cast<double>(sum.count) * area(sum.box) + right[i + 1];
    if (cost < best.cost) best.last = static_cast<int>(i), best.cost = cost;
  }
  return best;
}

}  // namespace

BoxTree::BoxTree(std::span<const BoundingBox> boxes) {
  if (boxes.size() >= kItems) throw std::invalid_argument("a BoxTree holds fewer than 2^31 boxes");
  for (const BoundingBox& box : boxes) requireNumbers(box);
  std::vector<std::uint32_t> numbers(boxes.size());
  std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
  leaves_.assign(boxes.size(), kNone);
  build(boxes, numbers, 0);
}

void BoxTree::rebuild() {
  rebuild(0);
}

void BoxTree::rebuild(std::size_t depth) {
  std::vector<BoundingBox> boxes;
  std::vector<std::uint32_t> numbers;
  boxes.reserve(size_);
  numbers.reserve(size_);
  for (std::uint32_t item = 0; item < leaves_.size(); ++item)
    if (leaves_[item] != kNone) {
      boxes.push_back(nodes_[leaves_[item]].box);
      numbers.push_back(item);
    }
  build(boxes, numbers, depth);
}

void BoxTree::build(std::span<const BoundingBox> boxes, std::span<const std::uint32_t> numbers,
                    std::size_t depth) {
  nodes_.clear();
  links_.clear();
  unused_.clear();
  nodes_.reserve(2 * boxes.size());
  links_.reserve(2 * boxes.size());
  size_ = boxes.size();
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  root_ = order.empty() ? kNone : buildNode(boxes, numbers, order, depth);
}

std::uint32_t BoxTree::buildNode(std::span<const BoundingBox> boxes,
                                 std::span<const std::uint32_t> numbers,
                                 std::span<std::uint32_t> order, std::size_t depth) {
  const std::uint32_t index = add(boxes[order[0]], numbers[order[0]], kNone);
  if (order.size() == 1) {
    leaves_[numbers[order[0]]] = index;
    return index;
  }
  BoundingBox box = boxes[order[0]];
  Vec3 low = twiceCentre(box), high = low;
  for (const std::uint32_t i : order) {
    extend(box, boxes[i]);
    low = low.cwiseMin(twiceCentre(boxes[i]));
    high = high.cwiseMax(twiceCentre(boxes[i]));
  }
  const std::size_t count = split(boxes, order, box, low, high, depth);
  const std::uint32_t left = buildNode(boxes, numbers, order.first(count), depth + 1),
                      right = buildNode(boxes, numbers, order.subspan(count), depth + 1);
  nodes_[index].left = left;
  nodes_[index].right = right;
  links_[left].parent = links_[right].parent = index;
  fit(index);
  return index;
}

std::size_t BoxTree::split(std::span<const BoundingBox> boxes, std::span<std::uint32_t> items,
                           const BoundingBox& all, const Vec3& low, const Vec3& high,
                           std::size_t depth) {
  // Halving at the median takes at most as many levels as the number of items has bits. The
  // heuristic may make unequal halves only while there are levels to spare. In a flat box the
  // heuristic can't compare splits, because all surfaces may be 0.
  if (area(all) > 0 && depth + std::bit_width(items.size()) < kMaxDepth) {
    Split best;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double width = high[axis] - low[axis];  // 0 if it underflows and is flushed to zero
      if (!(width > 0) || !std::isfinite(width)) continue;
      const Split found = bestSplit(boxes, items, {axis, low[axis], high[axis]});
      if (found.cost < best.cost) best = found;
    }
    if (std::isfinite(best.cost)) {
      const auto second = std::partition(items.begin(), items.end(), [&](std::uint32_t item) {
        return best.bins.of(boxes[item]) <= best.last;
      });
      return static_cast<std::size_t>(second - items.begin());
    }
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t half = items.size() / 2;
  const auto key = [&](std::uint32_t item) {
    const double x = twiceCentre(boxes[item])[axis];
    return x == x ? x : -std::numeric_limits<double>::infinity();
  };
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double x = key(a), y = key(b);
                     // Ties are broken by index, so that every standard library builds the same
                     // tree.
                     return x < y || (x == y && a < b);
                   });
  return half;
}

std::uint32_t BoxTree::add(const BoundingBox& box, std::uint32_t left, std::uint32_t right) {
  auto index = static_cast<std::uint32_t>(nodes_.size());
  if (unused_.empty()) {
    nodes_.emplace_back();
    links_.emplace_back();
  } else {
    index = unused_.back();
    unused_.pop_back();
    links_[index] = {};
  }
  nodes_[index] = {box, left, right};
  return index;
}

void BoxTree::fit(std::uint32_t node) {
  Node& n = nodes_[node];
  n.box = nodes_[n.left].box;
  extend(n.box, nodes_[n.right].box);
  n.box.terms = std::max(n.box.terms, n.box.lower.cwiseAbs().sum() + n.box.upper.cwiseAbs().sum());
  links_[node].height = 1 + std::max(links_[n.left].height, links_[n.right].height);
}

void BoxTree::fitUpwards(std::uint32_t node) {
  for (; node != kNone; node = links_[node].parent) fit(node);
}

void BoxTree::rotateUpwards(std::uint32_t node) {
  for (; node != kNone; node = links_[node].parent) {
    const std::uint32_t left = nodes_[node].left, right = nodes_[node].right;
    const std::uint32_t low = links_[left].height, high = links_[right].height;
    if (std::max(low, high) > std::min(low, high) + 1) {
      const std::uint32_t taller = low > high ? left : right;
      // The taller child takes the place of the node and becomes its parent. The shorter child of
      // the taller child becomes a child of the node.
      const bool leftTaller =
          links_[nodes_[taller].left].height > links_[nodes_[taller].right].height;
      const std::uint32_t moved = leftTaller ? nodes_[taller].right : nodes_[taller].left;
      setChild(links_[node].parent, node, taller);
      setChild(taller, moved, node);
      setChild(node, taller, moved);
      fit(node);
      node = taller;
    }
    fit(node);
  }
}

void BoxTree::setChild(std::uint32_t parent, std::uint32_t before, std::uint32_t after) {
  links_[after].parent = parent;
  if (parent == kNone)
    root_ = after;
  else if (nodes_[parent].left == before)
    nodes_[parent].left = after;
  else
    nodes_[parent].right = after;
}

std::uint32_t BoxTree::leafOf(std::size_t item) const {
  if (!contains(item)) throw std::invalid_argument("the BoxTree does not contain the item");
  return leaves_[item];
}

std::uint32_t BoxTree::siblingFor(const BoundingBox& box) const {
  const auto with = [&](std::uint32_t node) {
    BoundingBox both = nodes_[node].box;
    extend(both, box);
    return area(both);
  };
  std::uint32_t at = root_;
  while (!nodes_[at].isLeaf()) {
    // A new parent at this node costs the new parent's surface. A new parent further down also
    // costs the growth of this node.
    const double here = with(at), growth = here - area(nodes_[at].box);
    const auto below = [&](std::uint32_t child) {
      const double whole = with(child);
      return growth + (nodes_[child].isLeaf() ? whole : whole - area(nodes_[child].box));
    };
    const std::uint32_t left = nodes_[at].left, right = nodes_[at].right;
    const double costLeft = below(left), costRight = below(right);
    if (here < costLeft && here < costRight) break;
    // If the costs are equal, or are not numbers because a box is infinite, the search descends
    // into the child of smaller height.
    const bool isShorter = links_[left].height <= links_[right].height;
    at = costLeft < costRight || (!(costRight < costLeft) && isShorter) ? left : right;
  }
  return at;
}

void BoxTree::insert(std::size_t item, const BoundingBox& box) {
  requireNumbers(box);
  if (item >= kItems)
    throw std::invalid_argument("numbers of items in a BoxTree must be below 2^31");
  if (contains(item)) throw std::invalid_argument("the BoxTree contains the item already");
  if (item >= leaves_.size()) leaves_.resize(item + 1, kNone);
  const std::uint32_t leaf = add(box, static_cast<std::uint32_t>(item), kNone);
  leaves_[item] = leaf;
  ++size_;
  if (root_ == kNone) {
    root_ = leaf;
    return;
  }
  const std::uint32_t sibling = siblingFor(box), above = links_[sibling].parent;
  const std::uint32_t parent = add(box, sibling, leaf);
  setChild(above, sibling, parent);
  links_[sibling].parent = links_[leaf].parent = parent;
  fitUpwards(parent);
  // A tree built by surfaces may be deeper than a balanced tree. Only a tree that is far deeper is
  // balanced, by rotations above the new leaf.
  const std::size_t balanced = std::bit_width(size_);
  if (links_[root_].height > std::min(2 * balanced + 4, kMaxDepth - 4)) rotateUpwards(parent);
  // Building as if the root were at half of the largest depth leaves levels for the next
  // insertions.
  if (links_[root_].height > kMaxDepth) rebuild(kMaxDepth / 2);
}

void BoxTree::remove(std::size_t item) {
  const std::uint32_t leaf = leafOf(item), parent = links_[leaf].parent;
  leaves_[item] = kNone;
  --size_;
  unused_.push_back(leaf);
  if (parent == kNone) {
    root_ = kNone;
    return;
  }
  const std::uint32_t sibling =
      nodes_[parent].left == leaf ? nodes_[parent].right : nodes_[parent].left;
  const std::uint32_t above = links_[parent].parent;
  setChild(above, parent, sibling);
  unused_.push_back(parent);
  fitUpwards(above);
}

void BoxTree::refit(std::size_t item, const BoundingBox& box) {
  requireNumbers(box);
  const std::uint32_t leaf = leafOf(item);
  nodes_[leaf].box = box;
  fitUpwards(links_[leaf].parent);
}

bool BoxTree::check() const {
  const auto holds = [](const BoundingBox& outer, const BoundingBox& inner) {
    return (outer.lower.array() <= inner.lower.array()).all() &&
           (outer.upper.array() >= inner.upper.array()).all() && outer.terms >= inner.terms;
  };
  std::size_t items = 0;
  for (std::size_t item = 0; item < leaves_.size(); ++item) {
    if (leaves_[item] == kNone) continue;
    ++items;
    std::uint32_t node = leaves_[item];
    if (!nodes_[node].isLeaf() || nodes_[node].left != item) return false;
    std::size_t depth = 0;
    for (; links_[node].parent != kNone; node = links_[node].parent, ++depth) {
      const std::uint32_t parent = links_[node].parent;
      if ((nodes_[parent].left == node) == (nodes_[parent].right == node)) return false;
      if (!holds(nodes_[parent].box, nodes_[node].box)) return false;
      if (links_[parent].height <= links_[node].height) return false;
    }
    if (node != root_ || depth > kMaxDepth) return false;
  }
  const std::size_t used = nodes_.size() - unused_.size();  // a binary tree of `size_` leaves
  return items == size_ && (root_ == kNone) == (size_ == 0) &&
         used == (size_ == 0 ? 0 : 2 * size_ - 1);
}

}  // namespace corridor
