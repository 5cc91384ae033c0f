#include "collision/geometry/mesh_components.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

constexpr std::uint32_t kNoComponent = std::numeric_limits<std::uint32_t>::max();

/// One triangle's use of an edge.
struct Use {
  std::uint64_t edge;  ///< identifies the edge; the same number for both directions
  bool forward;
  std::uint32_t triangle;
};

/// Disjoint sets of triangles; each has a root (union-find).
class Sets {
 public:
  explicit Sets(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t k) { parent_[root(i)] = root(k); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

MeshComponents findComponents(const TriangleMesh& mesh) {
  VertexWelder welder(mesh.vertices.size());
  std::vector<Use> uses;
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  // Triangles with two equal corners do not count for watertightness.
  std::vector<bool> folded(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    std::uint32_t corner[3];
    for (int i = 0; i < 3; ++i) corner[i] = welder.addOrFind(mesh.corner(t, i));
    folded[t] = corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = corner[i], b = corner[(i + 1) % 3];
      if (a != b) uses.push_back({std::uint64_t{std::min(a, b)} << 32 | std::max(a, b), a < b, t});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& u, const Use& v) { return u.edge < v.edge; });

  Sets sets(count);
  std::vector<std::uint32_t> open;  // triangles of components that are not watertight
  for (std::size_t i = 0; i < uses.size();) {
    std::size_t end = i;
    int forward = 0, backward = 0;
    for (; end < uses.size() && uses[end].edge == uses[i].edge; ++end) {
      sets.join(uses[end].triangle, uses[i].triangle);
      if (!folded[uses[end].triangle]) ++(uses[end].forward ? forward : backward);
    }
    if (forward + backward > 0 && (forward != 1 || backward != 1)) open.push_back(uses[i].triangle);
    i = end;
  }

  MeshComponents all;
  all.of.assign(count, kNoComponent);
  std::vector<std::uint32_t> number(count, kNoComponent);  // the component of each root
  for (std::uint32_t t = 0; t < count; ++t) {
    std::uint32_t& n = number[sets.root(t)];
    if (n == kNoComponent) {
      n = static_cast<std::uint32_t>(all.components.size());
      all.components.push_back({t, mesh.corner(t, 0), mesh.corner(t, 0), mesh.corner(t, 0), false});
    }
    all.of[t] = n;
    MeshComponents::Component& component = all.components[n];
    component.watertight = component.watertight || !folded[t];  // open edges clear it below
    for (int i = 0; i < 3; ++i) {
      component.lower = component.lower.cwiseMin(mesh.corner(t, i));
      component.upper = component.upper.cwiseMax(mesh.corner(t, i));
    }
  }
  for (const std::uint32_t t : open) all.components[all.of[t]].watertight = false;
  return all;
}

}  // namespace corridor
