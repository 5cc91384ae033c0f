#include "planner/verify/body_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace corridor::verify {
namespace {

/// Pairs are pruned if their lower bound is at least this fraction of the smallest distance found
/// so far. The fraction is below 1, so that ties are pruned: many triangles share the closest
/// vertex or edge, and their bounds may round up or down.
constexpr Real kSame = 1 - 0x1p-30L;

void extend(BodyTree::Node& node, const LeafPrimitive& leaf) {
  if (!leaf.part) {
    for (const Vec3& corner : leaf.corners) {
      node.lower = node.lower.cwiseMin(corner);
      node.upper = node.upper.cwiseMax(corner);
    }
    return;
  }
  for (const Vec3& point : leaf.part->points)
    for (int i = 0; i < 3; ++i) {  // rounded outward; the disc about a point is within its sphere
      node.lower[i] =
          std::min(node.lower[i], std::nextafter(point[i] - leaf.part->radius, -HUGE_VAL));
      node.upper[i] =
          std::max(node.upper[i], std::nextafter(point[i] + leaf.part->radius, HUGE_VAL));
    }
}

}  // namespace

BodyTree::BodyTree(const TriangleMesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    LeafPrimitive leaf;
    for (int i = 0; i < 3; ++i) {
      leaf.corners[static_cast<std::size_t>(i)] = mesh.corner(t, i);
      radius_ = std::max(radius_, mesh.corner(t, i).cast<Real>().norm());
    }
    leaf.number = t;
    const RealVec first = leaf.corners[0].cast<Real>();
    const RealVec normal =
        (leaf.corners[1].cast<Real>() - first).cross(leaf.corners[2].cast<Real>() - first);
    if (const Real length = normal.norm(); length > 0) leaf.normal = normal / length;
    leaves_.push_back(leaf);
  }
  radius_ *= 1 + 0x1p-60L;
  build();
}

BodyTree::BodyTree(std::span<const ConvexPart> parts) {
  for (const ConvexPart& part : parts) {
    LeafPrimitive leaf;
    leaf.part = &part;
    leaf.number = static_cast<std::uint32_t>(leaves_.size());
    leaves_.push_back(leaf);
    Real farthest = 0;
    for (const Vec3& point : part.points) farthest = std::max(farthest, point.cast<Real>().norm());
    radius_ = std::max(radius_, (farthest + part.radius) * (1 + 0x1p-60L));
  }
  build();
}

void BodyTree::build() {
  nodes_.reserve(2 * leaves_.size());
  std::vector<std::uint32_t> order(leaves_.size());
  std::iota(order.begin(), order.end(), 0u);
  build(order, 0, order.size());
}

std::uint32_t BodyTree::build(std::vector<std::uint32_t>& order, std::size_t begin,
                              std::size_t end) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  Node node;
  node.lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  node.upper = -node.lower;
  for (std::size_t i = begin; i < end; ++i) extend(node, leaves_[order[i]]);
  nodes_.push_back(node);
  if (end - begin == 1) {
    nodes_[index].leaf = order[begin];
    return index;
  }
  int axis = 0;
  (0.5 * node.upper - 0.5 * node.lower).maxCoeff(&axis);
  const auto key = [&](std::uint32_t i) {
    if (const ConvexPart* part = leaves_[i].part) {
      Real sum = 0;
      for (const Vec3& point : part->points) sum += point[axis];
      return sum / static_cast<Real>(part->points.size());
    }
    const Corners& c = leaves_[i].corners;
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

template <>
const BodyDistance::Frame<Real>& BodyDistance::frame() const {
  return real_;
}
template <>
const BodyDistance::Frame<double>& BodyDistance::frame() const {
  return double_;
}

void BodyDistance::place(const BodyTree& a, const BodyTree& b, const Placement& X_AB) {
  a_ = &a;
  b_ = &b;
  X_AB_ = X_AB;
  real_ = {X_AB.rotation, X_AB.rotation.cwiseAbs(), X_AB.position};
  double_ = {X_AB.rotation.cast<double>(), real_.extents.cast<double>(),
             X_AB.position.cast<double>()};
  const Real size = a.radius() + b.radius() + X_AB.position.norm();
  boxError_ =
      0x1p-400L < size && size < 0x1p400L ? 0x1p-44L * size : std::numeric_limits<Real>::infinity();
  partA_.reset();
  partB_.reset();
  if (a.hasParts() && a.size() == 1) partA_ = placed(*a.leaf(0).part, Placement{});
  if (b.hasParts() && b.size() == 1) partB_ = placed(*b.leaf(0).part, X_AB);
  lookAlong(RealVec::Zero());
  ++stamp_;
  if (boxesB_.size() < b.size()) boxesB_.resize(b.size());
}

template <class Number>
BodyDistance::Box<Number> BodyDistance::boxOf(const BodyTree::Node& node) {
  const Vec<Number> lower = node.lower.cast<Number>(), upper = node.upper.cast<Number>();
  return {(lower + upper) / 2, (upper - lower) / 2};
}

template <class Number>
BodyDistance::PlacedBox<Number> BodyDistance::placedBox(std::uint32_t node) const {
  const Frame<Number>& X = frame<Number>();
  PlacedBox<Number> box;
  box.along = boxOf<Number>(b_->node(node));
  box.along.centre = X.rotation * box.along.centre + X.position;
  const std::uint32_t leaf = b_->node(node).leaf;
  if (leaf != BodyTree::noLeaf && !b_->hasParts()) {
    const auto t = cornersB<Number>(leaf);
    const Vec<Number> least = t[0].cwiseMin(t[1]).cwiseMin(t[2]);
    const Vec<Number> most = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    box.around = {(least + most) / 2, (most - least) / 2};
  } else {
    box.around = {box.along.centre, X.extents * box.along.half};
  }
  return box;
}

const BodyDistance::PlacedBox<double>& BodyDistance::boxB(std::uint32_t node) {
  StampedBox& known = boxesB_[node];
  if (known.stamp != stamp_) known = {placedBox<double>(node), stamp_};
  return known.box;
}

CentredBox BodyDistance::aroundA(std::uint32_t node) const {
  const Box<Real> box = boxOf<Real>(a_->node(node));
  return {box.centre, box.half};
}

CentredBox BodyDistance::aroundB(std::uint32_t node) {
  if (!std::isfinite(boxError_)) {
    const Box<Real> box = placedBox<Real>(node).around;
    return {box.centre, box.half};
  }
  const Box<double>& box = boxB(node).around;
  return {box.centre.cast<Real>(), box.half.cast<Real>() + RealVec::Constant(boxError_)};
}

void BodyDistance::lookAlong(const RealVec& between) {
  const Real length = between.norm();
  RealVec& direction = real_.direction;
  direction = length > 0 ? RealVec(between / length) : RealVec::Zero();
  double_.direction = direction.cast<double>();
  if (partA_) endOfA_ = direction.dot(partA_->farthest(direction)) + partA_->sweptRadius();
  if (partB_) startOfB_ = direction.dot(partB_->farthest(-direction)) - partB_->sweptRadius();
}

Real BodyDistance::boxGap(std::uint32_t a, std::uint32_t b, Real enough) {
  if (std::isfinite(boxError_)) {
    const Real bound =
        boxGap<double>(a, b, boxB(b), static_cast<double>(enough + boxError_)) - boxError_;
    if (bound >= enough || bound + 2 * boxError_ < enough) return bound;
  }
  return boxGap<Real>(a, b, placedBox<Real>(b), enough);
}

template <class Number>
Number BodyDistance::boxGap(std::uint32_t a, std::uint32_t b, const PlacedBox<Number>& boxOfB,
                            Number enough) const {
  const Frame<Number>& X = frame<Number>();
  const Box<Number> boxOfA = boxOf<Number>(a_->node(a));
  // Bounds the distance of the two boxes, first along a's axes, then along b's.
  const auto apart = [](const Vec<Number>& between, const Vec<Number>& halves) {
    const Vec<Number> gaps = (between.cwiseAbs() - halves).cwiseMax(Vec<Number>::Zero());
    return gaps.norm();
  };
  Number gap = apart(boxOfB.around.centre - boxOfA.centre, boxOfB.around.half + boxOfA.half);
  if (gap >= enough) return gap;
  gap = std::max(gap, apart(X.rotation.transpose() * (boxOfB.along.centre - boxOfA.centre),
                            boxOfB.along.half + X.extents.transpose() * boxOfA.half));
  if (gap >= enough) return gap;
  const Vec<Number> along = X.direction.cwiseAbs();
  const Number endOfA = partA_ ? static_cast<Number>(endOfA_)
                               : X.direction.dot(boxOfA.centre) + along.dot(boxOfA.half);
  const Number startOfB =
      partB_ ? static_cast<Number>(startOfB_)
             : X.direction.dot(boxOfB.around.centre) - along.dot(boxOfB.around.half);
  gap = std::max(gap, startOfB - endOfA);
  if (gap >= enough) return gap;
  // For a long triangle that is oblique to the axes, the slab along the triangle's normal gives a
  // better bound than the triangle's box.
  if (const std::uint32_t leaf = a_->node(a).leaf; leaf != BodyTree::noLeaf && !a_->hasParts())
    gap = std::max(gap, planeGap<Number>(a_->leaf(leaf).normal.template cast<Number>(),
                                         cornersA<Number>(leaf), boxOfB.around));
  if (const std::uint32_t leaf = b_->node(b).leaf; leaf != BodyTree::noLeaf && !b_->hasParts())
    gap = std::max(gap, planeGap<Number>(X.rotation * b_->leaf(leaf).normal.template cast<Number>(),
                                         cornersB<Number>(leaf), boxOfA));
  return gap;
}

template <class Number>
Number BodyDistance::planeGap(const Vec<Number>& normal, const std::array<Vec<Number>, 3>& corners,
                              const Box<Number>& box) {
  // Any direction gives a true bound, so the corners need not be exactly in one plane.
  const Number centre = normal.dot(box.centre), half = normal.cwiseAbs().dot(box.half);
  const Number at[3] = {normal.dot(corners[0]), normal.dot(corners[1]), normal.dot(corners[2])};
  return std::max(centre - std::max({at[0], at[1], at[2]}),
                  std::min({at[0], at[1], at[2]}) - centre) -
         half;
}

template <class Number>
std::array<BodyDistance::Vec<Number>, 3> BodyDistance::cornersA(std::uint32_t leaf) const {
  const Corners& c = a_->leaf(leaf).corners;
  return {c[0].cast<Number>(), c[1].cast<Number>(), c[2].cast<Number>()};
}

template <class Number>
std::array<BodyDistance::Vec<Number>, 3> BodyDistance::cornersB(std::uint32_t leaf) const {
  const Frame<Number>& X = frame<Number>();
  std::array<Vec<Number>, 3> result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = X.rotation * b_->leaf(leaf).corners[i].template cast<Number>() + X.position;
  return result;
}

ConvexSet BodyDistance::setA(std::uint32_t leaf) const {
  if (partA_) return *partA_;
  if (a_->hasParts()) return placed(*a_->leaf(leaf).part, Placement{});
  const auto corners = cornersA(leaf);
  return {{corners.begin(), corners.end()}, 0, false, RealVec::Zero()};
}

ConvexSet BodyDistance::setB(std::uint32_t leaf) const {
  if (partB_) return *partB_;
  if (b_->hasParts()) return placed(*b_->leaf(leaf).part, X_AB_);
  const auto corners = cornersB(leaf);
  return {{corners.begin(), corners.end()}, 0, false, RealVec::Zero()};
}

DistanceBounds BodyDistance::gap(LeafPair pair, const RealVec& guess, Real enough) const {
  if (a_->hasParts() || b_->hasParts()) return convexGap(setA(pair.a), setB(pair.b), guess, enough);
  return triangleGap(cornersA(pair.a).data(), cornersB(pair.b).data());
}

std::array<BodyDistance::Item, 2> BodyDistance::split(const Item& whole, Real enough) {
  const BodyTree::Node &a = a_->node(whole.a), &b = b_->node(whole.b);
  const bool leafA = a.leaf != BodyTree::noLeaf, leafB = b.leaf != BodyTree::noLeaf;
  const bool splitB =
      !leafB && (leafA || boxB(whole.b).around.half.maxCoeff() >= boxOf<double>(a).half.maxCoeff());
  if (splitB) return {item(whole.a, b.left, enough), item(whole.a, b.right, enough)};
  return {item(a.left, whole.b, enough), item(a.right, whole.b, enough)};
}

BodyGap BodyDistance::measure(LeafPair guess, Real doubt, Real stop,
                              const std::function<bool(LeafPair)>& touches) {
  BodyGap best;
  lookAlong(RealVec::Zero());
  Real enough = stop;
  const auto test = [&](LeafPair pair) {
    DistanceBounds found;
    if (!a_->hasParts() &&
        !b_->hasParts()) {  // slabs are tried first: they cost less than the distance
      const auto a = cornersA(pair.a), b = cornersB(pair.b);
      const RealVec normals[2] = {a_->leaf(pair.a).normal,
                                  X_AB_.rotation * b_->leaf(pair.b).normal};
      found.lower = slabWidth(a.data(), b.data(), real_.direction);
      for (const RealVec& n : normals)
        if (found.lower < enough)
          found.lower = std::max(
              {found.lower, slabWidth(a.data(), b.data(), n), slabWidth(a.data(), b.data(), -n)});
    }
    if (found.lower < enough) found = gap(pair, real_.direction, enough);
    best.lower = std::min(best.lower, found.lower);
    if (found.upper < best.upper) {
      best.upper = found.upper;
      best.pair = pair;
      best.onA = found.onA;
      best.onB = found.onB;
      enough =
          std::min(stop, std::max(kSame * best.upper,
                                  std::nextafter(doubt, std::numeric_limits<Real>::infinity())));
      if (found.onA != found.onB) lookAlong(found.onB - found.onA);
    }
    if (found.lower > doubt || !touches(pair)) return false;
    best = {0, 0, pair, found.onA, found.onB, true};
    return true;
  };

  stack_.assign(1, item(0, 0, enough));
  if (stack_.back().lower < enough && test(guess)) return best;
  while (!stack_.empty()) {
    const Item at = stack_.back();
    stack_.pop_back();
    if (at.lower >= enough) {
      best.lower = std::min(best.lower, at.lower);
      continue;
    }
    const std::uint32_t leafA = a_->node(at.a).leaf, leafB = b_->node(at.b).leaf;
    if (leafA != BodyTree::noLeaf && leafB != BodyTree::noLeaf) {
      if (test({leafA, leafB})) return best;
      continue;
    }
    auto [first, second] = split(at, enough);
    if (first.lower < second.lower) std::swap(first, second);
    stack_.push_back(first);
    stack_.push_back(second);  // the nearer one is next
  }
  return best;
}

bool BodyDistance::collectNear(Real within, std::size_t most, const Settled& settled,
                               std::vector<LeafPair>& pairs) {
  pairs.clear();
  stack_.assign(1, item(0, 0, within));
  while (!stack_.empty()) {
    const Item at = stack_.back();
    stack_.pop_back();
    if (at.lower >= within || settled(aroundA(at.a), aroundB(at.b))) continue;
    const std::uint32_t leafA = a_->node(at.a).leaf, leafB = b_->node(at.b).leaf;
    if (leafA != BodyTree::noLeaf && leafB != BodyTree::noLeaf) {
      if (pairs.size() == most) return false;
      pairs.push_back({leafA, leafB});
      continue;
    }
    for (const Item& half : split(at, within)) stack_.push_back(half);
  }
  return true;
}

}  // namespace corridor::verify
