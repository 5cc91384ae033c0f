#include "collision/geometry/mesh_health.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

enum class Quality { Fair, Sliver, Degenerate };

/// `diagonal` of the mesh's bounds: lengths are taken in it, so that nothing over- or underflows.
Quality qualityOf(const Vec3& a, const Vec3& b, const Vec3& c, double diagonal) {
  constexpr double degenerateArea = 1e-12, sliverRatio = 1e-3;  // by definition, see MeshHealth
  const Vec3 ab = b / diagonal - a / diagonal, ac = c / diagonal - a / diagonal,
             bc = c / diagonal - b / diagonal;
  const double doubleArea = ab.cross(ac).norm();
  if (a == b || b == c || c == a || !(doubleArea / 2 > degenerateArea)) return Quality::Degenerate;
  const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()});
  return doubleArea < sliverRatio * longest ? Quality::Sliver
                                            : Quality::Fair;  // height = doubleArea / longest edge
}

Triangle sorted(Triangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// An edge as one number, the same in both directions.
std::uint64_t undirected(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Calls `use(n)` with the length of each run of equal values. Sorts.
template <class Use>
void forEachRun(std::vector<std::uint64_t>& values, Use use) {
  std::sort(values.begin(), values.end());
  for (auto run = values.begin(); run != values.end();) {
    const auto end = std::find_if(run, values.end(), [&](std::uint64_t v) { return v != *run; });
    use(end - run);
    run = end;
  }
}

void countEdges(const std::vector<Triangle>& distinctFair, MeshHealth& health) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * distinctFair.size());
  for (const Triangle& t : distinctFair) {
    for (int i = 0; i < 3; ++i) edges.push_back(undirected(t[i], t[(i + 1) % 3]));
  }
  forEachRun(edges, [&](std::ptrdiff_t uses) {
    if (uses == 1) ++health.boundaryEdges;
    if (uses >= 3) ++health.nonManifoldEdges;
  });
}

bool isWatertight(const std::vector<Triangle>& triangles) {
  std::vector<std::uint64_t> forward, backward;
  for (const Triangle& t : triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      (a < b ? forward : backward).push_back(undirected(a, b));
    }
  }
  std::sort(forward.begin(), forward.end());
  std::sort(backward.begin(), backward.end());
  return !forward.empty() && forward == backward &&
         std::adjacent_find(forward.begin(), forward.end()) == forward.end();
}

std::size_t countComponents(const std::vector<Triangle>& triangles, std::size_t points) {
  std::vector<std::uint32_t> parent(points);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::size_t components = points;  // every point is a corner of some triangle
  for (const Triangle& t : triangles) {
    for (int i = 1; i < 3; ++i) {
      const std::uint32_t a = root(t[0]), b = root(t[i]);
      if (a == b) continue;
      parent[b] = a;
      --components;
    }
  }
  return components;
}

/// By the divergence theorem, about the bounds' centre: less cancellation far from the origin.
double volumeOf(const std::vector<Triangle>& triangles, const std::vector<Vec3>& points,
                const Vec3& centre) {
  double sum = 0;
  for (const Triangle& t : triangles) {
    sum += (points[t[0]] - centre).dot((points[t[1]] - centre).cross(points[t[2]] - centre));
  }
  return sum / 6;
}

}  // namespace

MeshHealth inspectMesh(const TriangleMesh& mesh) {
  MeshHealth health;
  health.triangles = mesh.triangles.size();
  if (mesh.triangles.empty()) return health;

  VertexWelder welder(mesh.vertices.size());
  std::vector<Triangle> triangles = mesh.triangles;
  for (Triangle& t : triangles) {
    for (std::uint32_t& corner : t) corner = welder.index(mesh.vertices[corner]);
  }
  const std::vector<Vec3> points = welder.takePoints();
  health.min = health.max = points.front();
  for (const Vec3& p : points) {
    health.min = health.min.cwiseMin(p);
    health.max = health.max.cwiseMax(p);
  }
  const double diagonal = (health.max / 2 - health.min / 2).stableNorm() * 2;

  std::vector<Triangle> all, fair;  // corners sorted; then made distinct
  for (const Triangle& t : triangles) {
    const Quality quality = qualityOf(points[t[0]], points[t[1]], points[t[2]], diagonal);
    health.degenerateTriangles += quality == Quality::Degenerate;
    health.sliverTriangles += quality == Quality::Sliver;
    all.push_back(sorted(t));
    if (quality != Quality::Degenerate) fair.push_back(all.back());
  }
  const auto makeDistinct = [](std::vector<Triangle>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  makeDistinct(all);
  makeDistinct(fair);
  health.distinctTriangles = all.size();
  countEdges(fair, health);
  health.components = countComponents(triangles, points.size());
  health.watertight = isWatertight(triangles);
  if (health.watertight)
    health.volume = volumeOf(triangles, points, health.min / 2 + health.max / 2);
  return health;
}

std::optional<std::string> checkMesh(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite())
      return "vertex " + std::to_string(i) + " (from 0) is not finite";
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (corner < mesh.vertices.size()) continue;
      return "face " + std::to_string(i) + " (from 0): index " + std::to_string(corner) +
             " is out of range: there are " + std::to_string(mesh.vertices.size()) + " vertices";
    }
  }
  return std::nullopt;
}

}  // namespace corridor
