#include "collision/geometry/mesh_health.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

using Indices = std::array<std::uint32_t, 3>;

/// The bounds of the corners of triangles. Lengths are measured in units of the diagonal of the
/// bounds. So their squares neither overflow nor underflow because of the size of a mesh.
struct Bounds {
  Vec3 min, max;
  /// 1/4 if the diagonal overflows; else 1, because subnormals times 1/4 would lose bits.
  double scale = 1;
  double diagonal;  ///< length of the diagonal, times `scale`

  explicit Bounds(const TriangleMesh& mesh) : min(mesh.corner(0, 0)), max(min) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        min = min.cwiseMin(mesh.corner(i, k));
        max = max.cwiseMax(mesh.corner(i, k));
      }
    if (!std::isfinite((max - min).stableNorm())) scale = 0.25;
    diagonal = (scale * max - scale * min).stableNorm();
  }
  /// Returns the vector from `from` to `to`, divided by the diagonal.
  Vec3 inDiagonals(const Vec3& from, const Vec3& to) const {
    return (scale * to - scale * from) / diagonal;
  }
};

TriangleQuality qualityOf(const Vec3& a, const Vec3& b, const Vec3& c, const Bounds& bounds) {
  constexpr double degenerateArea = 1e-12, sliverRatio = 1e-3;  // defined in the header
  const Vec3 ab = bounds.inDiagonals(a, b), ac = bounds.inDiagonals(a, c),
             bc = bounds.inDiagonals(b, c);
  const double doubleArea = ab.cross(ac).norm();
  if (a == b || b == c || c == a || !(doubleArea / 2 > degenerateArea))
    return TriangleQuality::degenerate;
  const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), bc.squaredNorm()});
  // The height is doubleArea / longest edge.
  return doubleArea < sliverRatio * longest ? TriangleQuality::sliver : TriangleQuality::fair;
}

Indices sorted(Indices t) {
  std::sort(t.begin(), t.end());
  return t;
}

/// Returns a number that identifies the edge between two vertices. Both directions of the edge give
/// the same number.
std::uint64_t undirected(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// Sorts `values` and calls `use(n)` for each run of n equal values.
template <class Use>
void forEachRun(std::vector<std::uint64_t>& values, Use use) {
  std::sort(values.begin(), values.end());
  for (auto run = values.begin(); run != values.end();) {
    const auto end = std::find_if(run, values.end(), [&](std::uint64_t v) { return v != *run; });
    use(end - run);
    run = end;
  }
}

void countEdges(const std::vector<Indices>& distinctFair, MeshHealth& health) {
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * distinctFair.size());
  for (const Indices& t : distinctFair) {
    for (int i = 0; i < 3; ++i) edges.push_back(undirected(t[i], t[(i + 1) % 3]));
  }
  forEachRun(edges, [&](std::ptrdiff_t uses) {
    if (uses == 1) ++health.boundaryEdges;
    if (uses >= 3) ++health.nonManifoldEdges;
  });
}

/// The numbers of edges, by how many triangles use the edge, and in which directions. Triangles
/// with two equal corners do not count.
struct EdgeUses {
  std::size_t sound = 0;   ///< edges of two triangles, in opposite directions
  std::size_t open = 0;    ///< edges of one triangle
  std::size_t turned = 0;  ///< edges of two triangles, in the same direction
  std::size_t many = 0;    ///< edges of three triangles or more

  explicit EdgeUses(const std::vector<Indices>& triangles) {
    std::vector<std::uint64_t> forward, backward;
    for (const Indices& t : triangles) {
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        (a < b ? forward : backward).push_back(undirected(a, b));
      }
    }
    std::sort(forward.begin(), forward.end());
    std::sort(backward.begin(), backward.end());
    auto f = forward.begin(), b = backward.begin();
    while (f != forward.end() || b != backward.end()) {
      const std::uint64_t edge = b == backward.end()  ? *f
                                 : f == forward.end() ? *b
                                                      : std::min(*f, *b);
      std::size_t along = 0, against = 0;
      for (; f != forward.end() && *f == edge; ++f) ++along;
      for (; b != backward.end() && *b == edge; ++b) ++against;
      ++(along + against == 1 ? open : along + against > 2 ? many : along == 1 ? sound : turned);
    }
  }
  bool areWatertight() const { return sound > 0 && open + turned + many == 0; }
};

/// Returns the first reason why a mesh is not watertight. @pre the mesh is not watertight.
std::string whyNotWatertight(const EdgeUses& edges, bool repeated) {
  const auto ofEdges = [](std::size_t count) { return std::to_string(count) + " of its edges"; };
  if (edges.open > 0) return ofEdges(edges.open) + " have a triangle on one side only";
  if (edges.turned > 0) return "its triangles do not face the same way at " + ofEdges(edges.turned);
  if (edges.many > 0)
    return ofEdges(edges.many) + " have three triangles or more" +
           (repeated ? ", repeated ones included" : "");
  return "none of its triangles has three different corners";
}

std::size_t countComponents(const std::vector<Indices>& triangles, std::size_t points) {
  std::vector<std::uint32_t> parent(points);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  std::size_t components = points;  // every point is a corner of some triangle
  for (const Indices& t : triangles) {
    for (int i = 1; i < 3; ++i) {
      const std::uint32_t a = root(t[0]), b = root(t[i]);
      if (a == b) continue;
      parent[b] = a;
      --components;
    }
  }
  return components;
}

/// Returns the volume by the divergence theorem. The reference point is the centre of the bounds,
/// for less cancellation far from the origin.
double volumeOf(const std::vector<Indices>& triangles, const std::vector<Vec3>& points,
                const Bounds& bounds) {
  const Vec3 centre = bounds.min / 2 + bounds.max / 2;
  double sum = 0;
  for (const Indices& t : triangles) {
    const Vec3 a = bounds.inDiagonals(centre, points[t[0]]),
               b = bounds.inDiagonals(centre, points[t[1]]),
               c = bounds.inDiagonals(centre, points[t[2]]);
    sum += a.dot(b.cross(c));
  }
  const double diagonal = bounds.diagonal / bounds.scale;
  return sum / 6 * diagonal * diagonal * diagonal;
}

}  // namespace

MeshHealth inspectMesh(const TriangleMesh& mesh) {
  MeshHealth health;
  health.triangles = mesh.triangles.size();
  if (mesh.triangles.empty()) {
    health.whyNotWatertight = "there are no triangles";
    return health;
  }

  VertexWelder welder(mesh.vertices.size());
  std::vector<Indices> triangles = mesh.triangles;
  for (Indices& t : triangles) {
    for (std::uint32_t& corner : t) corner = welder.addOrFind(mesh.vertices[corner]);
  }
  const std::vector<Vec3> points = welder.takePoints();
  const Bounds bounds(mesh);
  health.min = bounds.min + Vec3::Zero();  // adding 0 turns -0 into 0
  health.max = bounds.max + Vec3::Zero();

  // Triangles with sorted corners; `makeDistinct` removes repeated ones.
  std::vector<Indices> all, fair;
  for (const Indices& t : triangles) {
    const auto quality = qualityOf(points[t[0]], points[t[1]], points[t[2]], bounds);
    health.degenerateTriangles += quality == TriangleQuality::degenerate;
    health.sliverTriangles += quality == TriangleQuality::sliver;
    all.push_back(sorted(t));
    if (quality != TriangleQuality::degenerate) fair.push_back(all.back());
  }
  const auto makeDistinct = [](std::vector<Indices>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  makeDistinct(all);
  makeDistinct(fair);
  health.distinctTriangles = all.size();
  countEdges(fair, health);
  health.components = countComponents(triangles, points.size());
  const EdgeUses edges(triangles);
  health.watertight = edges.areWatertight();
  health.misorientedEdges = edges.turned;
  if (!health.watertight)
    health.whyNotWatertight = whyNotWatertight(edges, health.distinctTriangles < health.triangles);
  if (health.watertight)
    if (const double volume = volumeOf(triangles, points, bounds); std::isfinite(volume))
      health.volume = volume;
  return health;
}

std::vector<TriangleQuality> triangleQualities(const TriangleMesh& mesh) {
  std::vector<TriangleQuality> qualities;
  if (mesh.triangles.empty()) return qualities;
  const Bounds bounds(mesh);
  qualities.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    qualities.push_back(qualityOf(mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2), bounds));
  return qualities;
}

std::optional<std::string> checkMesh(const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (!mesh.vertices[i].allFinite())
      return "vertex " + std::to_string(i) + " (counted from 0) is not finite";
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (corner < mesh.vertices.size()) continue;
      return "face " + std::to_string(i) + " (counted from 0): index " + std::to_string(corner) +
             " is out of range: there are " + std::to_string(mesh.vertices.size()) + " vertices";
    }
  }
  return std::nullopt;
}

}  // namespace corridor
