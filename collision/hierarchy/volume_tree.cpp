#include "collision/hierarchy/volume_tree.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/hierarchy/tree_builder.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {
namespace {

/// Returns the length, or infinity for NaN, which `std::max` could drop. With an infinite length no
/// test separates anything.
double orInfinite(double length) {
  return length < HUGE_VAL ? length : HUGE_VAL;
}

}  // namespace

template <BoundingVolume Volume>
VolumeTree<Volume>::VolumeTree(const TriangleMesh& mesh, const TreeParams& params) : items_(mesh) {
  build(params);
}

template <BoundingVolume Volume>
VolumeTree<Volume>::VolumeTree(const ConvexPart& part)
    : VolumeTree(std::vector<ConvexPart>{part}) {}

template <BoundingVolume Volume>
VolumeTree<Volume>::VolumeTree(std::vector<ConvexPart> parts, const TreeParams& params)
    : items_(std::move(parts)) {
  build(params);
}

template <BoundingVolume Volume>
void VolumeTree<Volume>::build(const TreeParams& params) {
  requireStandardFloatingPoint();
  if (items_.numbers.empty())
    throw std::invalid_argument("a tree needs at least one triangle or convex part");
  const Skeleton skeleton = buildSkeleton(items_, Volume::kOriented, params);
  nodes_.reserve(skeleton.size());
  for (const SkeletonNode& bone : skeleton)
    items_.withContent(bone.first, bone.count, [&](const Content& content) {
      nodes_.push_back({Volume::around(bone.box, content), 0, bone.first, bone.count, bone.right});
    });
  measure();
}

template <BoundingVolume Volume>
void VolumeTree<Volume>::measure() {
  bounds_ = {};
  for (Node& node : nodes_) {
    node.radius = orInfinite(node.box.radius());
    bounds_.axisDefect = std::max(bounds_.axisDefect, orInfinite(node.box.axisDefect()));
    bounds_.centerReach = std::max(bounds_.centerReach, orInfinite(node.box.centerReach()));
  }
  const auto reach = [&](const Vec3& p, double r) {
    bounds_.reach = std::max(bounds_.reach, roundedUp(p.stableNorm() + r));
  };
  for (const Triangle& t : items_.triangles)
    for (const Vec3& p : t) reach(p, 0);
  for (const ConvexPart& part : items_.parts)
    for (const Vec3& p : part.points) reach(p, part.radius);
}

template <BoundingVolume Volume>
void VolumeTree<Volume>::refit(const TriangleMesh& moved) {
  requireStandardFloatingPoint();
  for (std::uint32_t i = 0; i < items_.size(); ++i)
    for (int k = 0; k < 3; ++k) items_.triangles[i][k] = moved.corner(items_.numbers[i], k);
  for (std::size_t i = nodes_.size(); i-- > 0;) {  // children first
    Node& node = nodes_[i];
    if constexpr (requires { Volume::merged(node.box, node.box); }) {
      if (!node.isLeaf()) {
        node.box = Volume::merged(nodes_[i + 1].box, nodes_[node.right].box);
        continue;
      }
    }
    const Content content(std::span(items_.triangles).subspan(node.first, node.count));
    node.box = Volume::around(enclosingObb(content, node.box.frameAxes()), content);
  }
  measure();
}

template <BoundingVolume Volume>
std::size_t VolumeTree<Volume>::depth() const {
  std::size_t deepest = 0;
  std::vector<std::pair<std::uint32_t, std::size_t>> stack = {{0, 1}};
  while (!stack.empty()) {
    const auto [i, level] = stack.back();
    stack.pop_back();
    deepest = std::max(deepest, level);
    if (nodes_[i].isLeaf()) continue;
    stack.push_back({i + 1, level + 1});
    stack.push_back({nodes_[i].right, level + 1});
  }
  return deepest;
}

template <BoundingVolume Volume>
std::size_t VolumeTree<Volume>::bytes() const {
  std::size_t points = 0;
  for (const ConvexPart& part : items_.parts) points += part.points.capacity();
  std::size_t extra = 0;
  if constexpr (requires(const Volume& v) { v.extraBytes(); })
    for (const Node& node : nodes_) extra += node.box.extraBytes();
  return sizeof(*this) + nodes_.capacity() * sizeof(Node) + extra +
         items_.triangles.capacity() * sizeof(Triangle) +
         items_.parts.capacity() * sizeof(ConvexPart) + points * sizeof(Vec3) +
         items_.numbers.capacity() * sizeof(std::uint32_t);
}

#define CORRIDOR_TREE(Volume) template class VolumeTree<Volume>;
CORRIDOR_EACH_VOLUME(CORRIDOR_TREE)
#undef CORRIDOR_TREE

}  // namespace corridor
