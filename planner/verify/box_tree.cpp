#include "planner/verify/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace corridor::verify {

BoxTree::BoxTree(std::vector<SoupTriangle> soup) : soup_(std::move(soup)) {
  if (soup_.empty()) return;
  nodes_.reserve(2 * soup_.size());
  std::vector<std::uint32_t> order(soup_.size());
  std::iota(order.begin(), order.end(), 0u);
  build(order, 0, order.size());
}

std::uint32_t BoxTree::build(std::vector<std::uint32_t>& order, std::size_t begin,
                             std::size_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.lower = node.upper = soup_[order[begin]].corners[0];
  for (std::size_t i = begin; i < end; ++i) {
    for (const Vec3& corner : soup_[order[i]].corners) {
      node.lower = node.lower.cwiseMin(corner);
      node.upper = node.upper.cwiseMax(corner);
    }
  }
  nodes_.push_back(node);
  if (end - begin == 1) {
    nodes_[index].leaf = order[begin];
    return index;
  }
  int axis = 0;
  (0.5 * node.upper - 0.5 * node.lower).maxCoeff(&axis);
  const auto key = [&](std::uint32_t i) {
    const Corners& c = soup_[i].corners;
    return Real(c[0][axis]) + c[1][axis] + c[2][axis];
  };
  const std::size_t middle = begin + (end - begin) / 2;
  std::nth_element(order.begin() + static_cast<std::ptrdiff_t>(begin),
                   order.begin() + static_cast<std::ptrdiff_t>(middle),
                   order.begin() + static_cast<std::ptrdiff_t>(end),
                   [&](std::uint32_t i, std::uint32_t j) { return key(i) < key(j); });
  const std::uint32_t left = build(order, begin, middle), right = build(order, middle, end);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

SoupDistance::SoupDistance(const BoxTree& moving, const BoxTree& fixed)
    : moving_(moving), fixed_(fixed), movingBoxes_(moving.size()), stamps_(moving.size(), 0) {
  fixedBoxes_.reserve(fixed.size());
  for (std::uint32_t i = 0; i < fixed.size(); ++i) {
    const RealVec lower = fixed.node(i).lower.cast<Real>(),
                  upper = fixed.node(i).upper.cast<Real>();
    fixedBoxes_.push_back({(lower + upper) / 2, (upper - lower) / 2});
  }
}

const SoupDistance::Box& SoupDistance::movingBox(std::uint32_t node) {
  Box& box = movingBoxes_[node];
  if (stamps_[node] != stamp_) {
    const RealVec lower = moving_.node(node).lower.cast<Real>();
    const RealVec upper = moving_.node(node).upper.cast<Real>();
    box.centre = placement_.rotation * ((lower + upper) / 2) + placement_.position;
    box.half = placement_.rotation.cwiseAbs() * ((upper - lower) / 2);
    stamps_[node] = stamp_;
  }
  return box;
}

Real SoupDistance::boxGap(std::uint32_t moving, std::uint32_t fixed) {
  const Box &a = movingBox(moving), &b = fixedBoxes_[fixed];
  Real square = 0;
  for (int i = 0; i < 3; ++i) {
    const Real gap = std::abs(a.centre[i] - b.centre[i]) - a.half[i] - b.half[i];
    if (gap > 0) square += gap * gap;
  }
  return std::sqrt(square);
}

TriangleGap SoupDistance::gap(TrianglePair pair) const {
  RealVec a[3], b[3];
  for (int i = 0; i < 3; ++i) {
    a[i] = placement_.rotation * moving_.triangle(pair.moving).corners[i].cast<Real>() +
           placement_.position;
    b[i] = fixed_.triangle(pair.fixed).corners[i].cast<Real>();
  }
  return triangleGap(a, b);
}

SoupGap SoupDistance::measure(const Placement& placement, TrianglePair guess, Real doubt,
                              const std::function<bool(TrianglePair)>& touches) {
  SoupGap best;
  if (moving_.empty() || fixed_.empty()) return best;
  placement_ = placement;
  ++stamp_;
  const auto test = [&](TrianglePair pair) {
    const TriangleGap found = gap(pair);
    best.lower = std::min(best.lower, found.lower);
    if (found.upper < best.upper) {
      best.upper = found.upper;
      best.pair = pair;
      best.onFixed = found.onB;
    }
    if (found.lower > doubt || !touches(pair)) return false;
    best = {0, 0, pair, found.onB, true};
    return true;
  };

  if (test(guess)) return best;
  stack_.assign(1, {0, 0, boxGap(0, 0)});
  while (!stack_.empty()) {
    const Item item = stack_.back();
    stack_.pop_back();
    if (item.lower >= best.upper && item.lower > doubt) {
      best.lower = std::min(best.lower, item.lower);
      continue;
    }
    const BoxTree::Node &a = moving_.node(item.moving), &b = fixed_.node(item.fixed);
    const bool leafA = a.leaf != BoxTree::noLeaf, leafB = b.leaf != BoxTree::noLeaf;
    if (leafA && leafB) {
      if (test({a.leaf, b.leaf})) return best;
      continue;
    }
    const bool splitA = !leafA && (leafB || movingBox(item.moving).half.maxCoeff() >=
                                                fixedBoxes_[item.fixed].half.maxCoeff());
    Item first = splitA ? Item{a.left, item.fixed, 0} : Item{item.moving, b.left, 0};
    Item second = splitA ? Item{a.right, item.fixed, 0} : Item{item.moving, b.right, 0};
    first.lower = boxGap(first.moving, first.fixed);
    second.lower = boxGap(second.moving, second.fixed);
    if (first.lower < second.lower) std::swap(first, second);
    stack_.push_back(first);
    stack_.push_back(second);  // the nearer one next
  }
  return best;
}

}  // namespace corridor::verify
