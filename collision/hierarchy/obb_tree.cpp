#include "collision/hierarchy/obb_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "collision/core/rounding.h"
#include "collision/volumes/part_obb.h"

namespace corridor {
namespace {

/// Reorders [first, first + count) so that the triangles whose centroid lies below the plane come
/// first; returns how many.
std::uint32_t partition(std::vector<Triangle>& triangles, std::vector<std::uint32_t>& ids,
                        std::uint32_t first, std::uint32_t count, const Vec3& mean,
                        const Vec3& normal) {
  std::uint32_t below = first;
  for (std::uint32_t i = first; i < first + count; ++i) {
    const Triangle& t = triangles[i];
    // Relative to the mean before summing: far from the origin the sum of three corners would lose
    // the digits that tell.
    const double side = normal.dot((t[0] - mean) + (t[1] - mean) + (t[2] - mean));
    if (!(side < 0)) continue;
    std::swap(triangles[i], triangles[below]);
    std::swap(ids[i], ids[below]);
    ++below;
  }
  return below - first;
}

}  // namespace

ObbTree::ObbTree(const TriangleMesh& mesh, const ObbTreeParams& params) {
  triangles_.reserve(mesh.triangles.size());
  meshTriangle_.reserve(mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    triangles_.push_back({mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)});
    meshTriangle_.push_back(i);
  }
  for (const Triangle& t : triangles_)
    for (const Vec3& p : t) reach_ = std::max(reach_, roundedUp(p.stableNorm()));
  nodes_.reserve(2 * triangles_.size());

  struct Task {
    std::uint32_t first, count;
    std::int64_t
        parent;  // whose `right` this node becomes; −1: a left child, which follows its parent
  };
  std::vector<Task> tasks = {{0, static_cast<std::uint32_t>(triangles_.size()), -1}};
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    if (task.parent >= 0) nodes_[task.parent].right = index;
    const auto own = std::span(triangles_).subspan(task.first, task.count);
    const ObbFrame frame = fitFrame(own, params.fit);
    Node node;
    node.box = enclosingObb(own, frame.axes);
    node.first = task.first;
    node.count = task.count;
    addNode(node);
    if (task.count == 1) continue;

    std::array<int, 3> order = {0, 1, 2};
    std::ranges::sort(order, std::ranges::greater(), [&](int i) { return node.box.half[i]; });
    for (const int axis : order) {
      const std::uint32_t below = partition(triangles_, meshTriangle_, task.first, task.count,
                                            frame.mean, frame.axes.col(axis));
      if (below == 0 || below == task.count) continue;
      tasks.push_back({task.first + below, task.count - below, index});
      tasks.push_back({task.first, below, -1});
      break;
    }
  }
  nodes_.shrink_to_fit();
}

ObbTree::ObbTree(const ConvexPart& part) : part_(part) {
  for (const Vec3& p : part.points)
    reach_ = std::max(reach_, roundedUp(p.stableNorm() + part.radius));
  Node node;
  node.box = enclosingObb(part);
  addNode(node);
}

void ObbTree::addNode(const Node& node) {
  const double defect = orthonormalityDefect(node.box.axes);
  nodes_.push_back(node);
  nodes_.back().radius = roundedUp(node.box.half.stableNorm() * (1 + 3 * defect));
  axisDefect_ = std::max(axisDefect_, defect);
  centerReach_ = std::max(centerReach_, roundedUp(node.box.center.stableNorm()));
}

std::size_t ObbTree::depth() const {
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

std::size_t ObbTree::bytes() const {
  return sizeof(*this) + nodes_.capacity() * sizeof(Node) +
         triangles_.capacity() * sizeof(Triangle) +
         meshTriangle_.capacity() * sizeof(std::uint32_t) +
         (part_ ? part_->points.capacity() * sizeof(Vec3) : 0);
}

}  // namespace corridor
