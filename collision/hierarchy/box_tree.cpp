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

/// Bins along one axis, for centres from `low` to `high` (both twice the centre).
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

/// Returns the best split of the items between two bins of this axis, by the surface-area
/// heuristic: the expected number of boxes that a walk tests, if the query meets a child with a
/// probability in proportion to its surface. The cost is infinite if there is no split.
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
  if (boxes.size() >= std::size_t{1} << 31)
    throw std::invalid_argument("a BoxTree holds fewer than 2^31 boxes");
  std::vector<std::uint32_t> items(boxes.size());
  std::iota(items.begin(), items.end(), std::uint32_t{0});
  leaves_.assign(boxes.size(), kNone);
  build(boxes, std::move(items), 0);
}

void BoxTree::rebuild() {
  rebuild(0);
}

void BoxTree::rebuild(std::size_t depth) {
  std::vector<BoundingBox> boxes(leaves_.size());
  std::vector<std::uint32_t> items;
  for (std::uint32_t item = 0; item < leaves_.size(); ++item)
    if (leaves_[item] != kNone) {
      boxes[item] = nodes_[leaves_[item]].box;
      items.push_back(item);
    }
  build(boxes, std::move(items), depth);
}

void BoxTree::build(std::span<const BoundingBox> boxes, std::vector<std::uint32_t> items,
                    std::size_t depth) {
  nodes_.clear();
  links_.clear();
  unused_.clear();
  nodes_.reserve(2 * items.size());
  links_.reserve(2 * items.size());
  size_ = items.size();
  root_ = items.empty() ? kNone : buildNode(boxes, items, depth);
}

std::uint32_t BoxTree::buildNode(std::span<const BoundingBox> boxes, std::span<std::uint32_t> items,
                                 std::size_t depth) {
  const std::uint32_t index = add(boxes[items[0]], items[0], kNone);
  if (items.size() == 1) {
    leaves_[items[0]] = index;
    return index;
  }
  BoundingBox box = boxes[items[0]];
  Vec3 low = twiceCentre(box), high = low;
  for (const std::uint32_t item : items) {
    extend(box, boxes[item]);
    low = low.cwiseMin(twiceCentre(boxes[item]));
    high = high.cwiseMax(twiceCentre(boxes[item]));
  }
  const std::size_t count = split(boxes, items, box, low, high, depth);
  const std::uint32_t left = buildNode(boxes, items.first(count), depth + 1),
                      right = buildNode(boxes, items.subspan(count), depth + 1);
  nodes_[index].left = left;
  nodes_[index].right = right;
  links_[left].parent = links_[right].parent = index;
  fit(index);
  return index;
}

std::size_t BoxTree::split(std::span<const BoundingBox> boxes, std::span<std::uint32_t> items,
                           const BoundingBox& all, const Vec3& low, const Vec3& high,
                           std::size_t depth) {
  // Halving at the median takes at most as many levels as the items' number has bits. Only while
  // there are levels to spare, the heuristic may make unequal halves. In a flat box it can't
  // compare splits: all surfaces may be 0.
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
    // A new parent here costs its own surface. Further down, this node's growth comes in addition.
    const double here = with(at), growth = here - area(nodes_[at].box);
    const auto below = [&](std::uint32_t child) {
      const double whole = with(child);
      return growth + (nodes_[child].isLeaf() ? whole : whole - area(nodes_[child].box));
    };
    const double left = below(nodes_[at].left), right = below(nodes_[at].right);
    if (here < left && here < right) break;
    at = right < left ? nodes_[at].right : nodes_[at].left;
  }
  return at;
}

void BoxTree::insert(std::size_t item, const BoundingBox& box) {
  if (item >= std::size_t{1} << 31)
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
  // Counting from half of the depth leaves levels for the next insertions.
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
      if (nodes_[parent].left != node && nodes_[parent].right != node) return false;
      if (!holds(nodes_[parent].box, nodes_[node].box)) return false;
      if (links_[parent].height <= links_[node].height) return false;
    }
    if (node != root_ || depth > kMaxDepth) return false;
  }
  return items == size_ && (root_ == kNone) == (size_ == 0);
}

}  // namespace corridor
