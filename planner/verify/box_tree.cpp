#include "planner/verify/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace corridor::verify {
namespace {

/// Of the distance found: what comes no closer isn't looked at. Less than 1, since many triangles
/// share the closest vertex or edge, and their bounds round to either side of it.
constexpr Real kSame = 1 - 0x1p-30L;

}  // namespace

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
  if (stamps_[node] == stamp_) return box;
  stamps_[node] = stamp_;
  if (const std::uint32_t leaf = moving_.node(node).leaf; leaf != BoxTree::noLeaf) {
    const auto t = image(leaf);
    const RealVec lower = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
    const RealVec upper = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    box = {(lower + upper) / 2, (upper - lower) / 2};
  } else {
    const RealVec lower = moving_.node(node).lower.cast<Real>();
    const RealVec upper = moving_.node(node).upper.cast<Real>();
    box.centre = placement_.rotation * ((lower + upper) / 2) + placement_.position;
    box.half = placement_.rotation.cwiseAbs() * ((upper - lower) / 2);
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
  const Real slab =
      direction_.dot(b.centre - a.centre) - direction_.cwiseAbs().dot(a.half + b.half);
  return std::max(std::sqrt(square), slab);
}

std::array<RealVec, 3> SoupDistance::image(std::uint32_t triangle) const {
  std::array<RealVec, 3> result;
  for (int i = 0; i < 3; ++i) {
    result[i] = placement_.rotation * moving_.triangle(triangle).corners[i].cast<Real>() +
                placement_.position;
  }
  return result;
}

TriangleGap SoupDistance::gap(TrianglePair pair, Real enough) const {
  const auto a = image(pair.moving);
  const Corners& fixed = fixed_.triangle(pair.fixed).corners;
  const RealVec b[3] = {fixed[0].cast<Real>(), fixed[1].cast<Real>(), fixed[2].cast<Real>()};
  TriangleGap cheap;
  cheap.lower = slabWidth(a.data(), b, direction_);
  return cheap.lower >= enough ? cheap : triangleGap(a.data(), b);
}

SoupGap SoupDistance::measure(const Placement& placement, TrianglePair guess, Real doubt,
                              const std::function<bool(TrianglePair)>& touches) {
  SoupGap best;
  if (moving_.empty() || fixed_.empty()) return best;
  placement_ = placement;
  ++stamp_;
  direction_.setZero();
  Real enough = best.upper;
  const auto test = [&](TrianglePair pair) {
    const TriangleGap found = gap(pair, enough);
    best.lower = std::min(best.lower, found.lower);
    if (found.upper < best.upper) {
      best.upper = found.upper;
      best.pair = pair;
      best.onMoving = found.onA;
      best.onFixed = found.onB;
      enough = std::max(kSame * best.upper,
                        std::nextafter(doubt, std::numeric_limits<Real>::infinity()));
      direction_ = (found.onB - found.onA).normalized();
    }
    if (found.lower > doubt || !touches(pair)) return false;
    best = {0, 0, pair, found.onA, found.onB, true};
    return true;
  };

  if (test(guess)) return best;
  stack_.assign(1, {0, 0, boxGap(0, 0)});
  while (!stack_.empty()) {
    const Item item = stack_.back();
    stack_.pop_back();
    if (item.lower >= enough) {
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
