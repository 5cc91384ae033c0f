#include "collision/convex/enclosing_hull.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

constexpr std::size_t kMostVertices = 800;
constexpr std::size_t kSampledTriangles = 256;
constexpr double kDeepest = 0.35;  // mean depth of the triangles, as a part of the mesh's radius

/// Returns the distinct vertices that the triangles use; none if there are more than kMostVertices.
std::vector<Vec3> usedVertices(const TriangleMesh& mesh) {
  if (mesh.triangles.size() > 4 * kMostVertices) return {};  // a closed mesh has two a vertex
  VertexWelder points(kMostVertices);
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) points.addOrFind(mesh.vertices[v]);
    if (points.points().size() > kMostVertices) return {};
  }
  return points.takePoints();
}

/// Returns whether triangles lie, on average, not far below the surface of the hull of the points.
bool fits(const PointColumns& points, const TriangleMesh& mesh) {
  double square = 0;
  for (const Vec3& p : points.points())
    square = std::max(square, (p - points.center()).squaredNorm());
  double areas = 0, depths = 0;
  const std::size_t step = (mesh.triangles.size() - 1) / kSampledTriangles + 1;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += step) {
    const Vec3 a = mesh.corner(t, 0);
    const Vec3 normal = (mesh.corner(t, 1) - a).cross(mesh.corner(t, 2) - a);
    const double area = normal.norm();  // twice the area
    if (!(area > 0)) continue;
    areas += area;
    depths += normal.dot(points.points()[points.farthest(normal)] - a);
  }
  return areas > 0 && depths < kDeepest * std::sqrt(square) * areas;
}

}  // namespace

std::optional<PointColumns> enclosingHull(const TriangleMesh& mesh) {
  std::vector<Vec3> used = usedVertices(mesh);
  if (used.empty()) return std::nullopt;
  PointColumns points(std::move(used));
  if (!fits(points, mesh)) return std::nullopt;
  return points;
}

}  // namespace corridor
