#include "collision/hierarchy/box_tree.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace corridor {

BoxTree::BoxTree(std::span<const BoundingBox> boxes) {
  if (boxes.size() > std::size_t{1} << 31)
    throw std::invalid_argument("a BoxTree holds at most 2^31 boxes");
  std::vector<std::uint32_t> items(boxes.size());
  std::iota(items.begin(), items.end(), std::uint32_t{0});
  nodes_.reserve(2 * boxes.size());
  if (!items.empty()) build(boxes, items);
}

std::uint32_t BoxTree::build(std::span<const BoundingBox> boxes, std::span<std::uint32_t> items) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  if (items.size() == 1) {
    nodes_[index].box = boxes[items[0]];
    nodes_[index].item = items[0];
    return index;
  }
  BoundingBox box = boxes[items[0]];
  Vec3 low = box.lower + box.upper, high = low;  // twice the centres
  for (const std::uint32_t item : items) {
    const BoundingBox& other = boxes[item];
    box.lower = box.lower.cwiseMin(other.lower);
    box.upper = box.upper.cwiseMax(other.upper);
    box.terms = std::max(box.terms, other.terms);
    low = low.cwiseMin(other.lower + other.upper);
    high = high.cwiseMax(other.lower + other.upper);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const auto half = items.begin() + static_cast<std::ptrdiff_t>(items.size() / 2);
  std::nth_element(items.begin(), half, items.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double x = boxes[a].lower[axis] + boxes[a].upper[axis],
                 y = boxes[b].lower[axis] + boxes[b].upper[axis];
    // Ties are broken by index, so that every standard library builds the same tree.
    return x < y || (x == y && a < b);
  });
  box.terms = std::max(box.terms, box.lower.cwiseAbs().sum() + box.upper.cwiseAbs().sum());
  nodes_[index].box = box;
  build(boxes, items.first(items.size() / 2));
  nodes_[index].right = build(boxes, items.subspan(items.size() / 2));
  return index;
}

}  // namespace corridor
