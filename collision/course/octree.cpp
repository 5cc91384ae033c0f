#include "collision/course/octree.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/geometry/mesh_health.h"

namespace corridor {
namespace {

/// A closed box [low, high]. Neighbouring cells share their faces exactly, so rounding leaves no
/// gap between them.
struct Cell {
  Vec3 low, high;

  Vec3 middle() const { return low + 0.5 * (high - low); }
  Cell child(int octant) const {
    Cell c = *this;
    const Vec3 m = middle();
    for (int i = 0; i < 3; ++i) (octant >> i & 1 ? c.low : c.high)[i] = m[i];
    return c;
  }
  bool meets(const Cell& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  Aabb box() const {
    Aabb box{middle(), Vec3::Zero()};
    for (int i = 0; i < 3; ++i)
      box.half[i] = roundedUp(std::max(high[i] - box.center[i], box.center[i] - low[i]));
    return box;
  }
};

/// A cell is not divided if its children would list each triangle more often than this on average.
/// A surface of small triangles crosses about four of the eight children. Large triangles would be
/// listed in up to eight children.
constexpr std::size_t kSpread = 3;

Cell boundsOf(const Triangle& t) {
  return {t[0].cwiseMin(t[1]).cwiseMin(t[2]), t[0].cwiseMax(t[1]).cwiseMax(t[2])};
}

}  // namespace

Octree::Octree(const TriangleMesh& mesh, const OctreeParams& params) {
  requireStandardFloatingPoint();
  if (const auto complaint = checkMesh(mesh)) throw std::invalid_argument(*complaint);
  std::vector<Cell> extents;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    extents.push_back(boundsOf({mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)}));
    for (int k = 0; k < 3; ++k)
      bounds_.reach = std::max(bounds_.reach, roundedUp(mesh.corner(i, k).stableNorm()));
  }
  Cell root = extents[0];
  for (const Cell& e : extents) {
    root.low = root.low.cwiseMin(e.low);
    root.high = root.high.cwiseMax(e.high);
  }
  const double size = (root.high - root.low).maxCoeff();
  root.high = root.high.cwiseMax((root.low.array() + size).matrix());

  struct Task {
    Cell cell;
    std::uint32_t node, level;
    std::vector<std::uint32_t> inside;
  };
  std::vector<std::uint32_t> all(extents.size());
  std::iota(all.begin(), all.end(), 0U);
  std::vector<Task> tasks;
  tasks.push_back({root, 0, 0, std::move(all)});
  nodes_.emplace_back();
  while (!tasks.empty()) {
    const Task task = std::move(tasks.back());
    tasks.pop_back();
    Node& node = nodes_[task.node];
    node.box = task.cell.box();
    node.radius = node.box.radius();
    bounds_.centerReach = std::max(bounds_.centerReach, node.box.centerReach());
    std::vector<Task> parts;
    bool divides = task.inside.size() > params.leafTriangles && task.level < params.depth;
    if (divides) {
      for (int octant = 0; octant < 8; ++octant) {
        Task part{task.cell.child(octant), 0, task.level + 1, {}};
        for (const std::uint32_t t : task.inside)
          if (part.cell.meets(extents[t])) part.inside.push_back(t);
        if (!part.inside.empty()) parts.push_back(std::move(part));
      }
      std::size_t listed = 0;
      for (const Task& part : parts) listed += part.inside.size();
      divides = listed <= kSpread * task.inside.size();
    }
    if (!divides) {
      node.first = static_cast<std::uint32_t>(triangles_.size());
      node.count = static_cast<std::uint32_t>(task.inside.size());
      for (const std::uint32_t t : task.inside) {
        triangles_.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
        numbers_.push_back(t);
      }
      continue;
    }
    node.firstChild = static_cast<std::uint32_t>(nodes_.size());
    node.children = static_cast<std::uint32_t>(parts.size());
    for (Task& part : parts) {
      part.node = static_cast<std::uint32_t>(nodes_.size());
      nodes_.emplace_back();
      tasks.push_back(std::move(part));
    }
  }
}

std::size_t Octree::bytes() const {
  return sizeof(*this) + nodes_.capacity() * sizeof(Node) +
         triangles_.capacity() * sizeof(Triangle) + numbers_.capacity() * sizeof(std::uint32_t);
}

}  // namespace corridor
