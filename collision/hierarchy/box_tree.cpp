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
  if (boxes.size() > std::size_t{1} << 31)
    throw std::invalid_argument("a BoxTree holds at most 2^31 boxes");
  std::vector<std::uint32_t> items(boxes.size());
  std::iota(items.begin(), items.end(), std::uint32_t{0});
  nodes_.reserve(2 * boxes.size());
  if (!items.empty()) build(boxes, items, 0);
}

std::uint32_t BoxTree::build(std::span<const BoundingBox> boxes, std::span<std::uint32_t> items,
                             std::size_t depth) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  if (items.size() == 1) {
    nodes_[index].box = boxes[items[0]];
    nodes_[index].item = items[0];
    return index;
  }
  BoundingBox box = boxes[items[0]];
  Vec3 low = twiceCentre(box), high = low;
  for (const std::uint32_t item : items) {
    extend(box, boxes[item]);
    low = low.cwiseMin(twiceCentre(boxes[item]));
    high = high.cwiseMax(twiceCentre(boxes[item]));
  }
  box.terms = std::max(box.terms, box.lower.cwiseAbs().sum() + box.upper.cwiseAbs().sum());
  nodes_[index].box = box;
  const std::size_t left = split(boxes, items, box, low, high, depth);
  build(boxes, items.first(left), depth + 1);
  const std::uint32_t right = build(boxes, items.subspan(left), depth + 1);
  nodes_[index].right = right;
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

}  // namespace corridor
