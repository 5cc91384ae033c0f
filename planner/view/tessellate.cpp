#include "planner/view/tessellate.h"

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

namespace corridor::view {
namespace {

/// The numbers of meridians and parallels of the grid of directions.
struct Grid {
  int meridians = 16, parallels = 8;
};
constexpr Grid kCoarse{4, 2};  ///< with this grid, a ball becomes an octahedron

Vec3 farthest(const ConvexPart& part, const Vec3& axis, const Vec3& direction) {
  Vec3 best = part.points.front();
  for (const Vec3& p : part.points)
    if (p.dot(direction) > best.dot(direction)) best = p;
  const Vec3 out = part.flatEnds ? Vec3(direction - direction.dot(axis) * axis) : direction;
  return best + part.radius * (out.norm() > 1e-9 ? Vec3(out.normalized()) : Vec3::Zero());
}

TriangleMesh tessellated(const ConvexPart& part, const Grid& grid) {
  // Cylinders and capsules are tessellated in rings about their axis.
  const bool round = part.radius > 0 && part.points.size() == 2;
  const Vec3 axis = round ? Vec3((part.points[1] - part.points[0]).normalized()) : Vec3::UnitZ();
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  TriangleMesh mesh;
  std::map<std::tuple<double, double, double>, std::uint32_t> known;
  const auto vertex = [&](int parallel, int meridian) {
    const double polar = std::numbers::pi * parallel / grid.parallels,
                 angle = 2 * std::numbers::pi * (meridian % grid.meridians) / grid.meridians;
    const bool pole = parallel == 0 || parallel == grid.parallels;
    const Vec3 flat = pole ? Vec3(0 * u) : Vec3(std::cos(angle) * u + std::sin(angle) * v);
    const Vec3 p = farthest(
        part, axis, std::sin(polar) * flat + (pole ? (parallel ? -1 : 1) : std::cos(polar)) * axis);
    const auto [found, added] =
        known.try_emplace({p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(p);
    return found->second;
  };
  for (int i = 0; i < grid.parallels; ++i)
    for (int k = 0; k < grid.meridians; ++k) {
      const std::uint32_t a = vertex(i, k), b = vertex(i + 1, k), c = vertex(i + 1, k + 1),
                          d = vertex(i, k + 1);
      if (a != b && b != c && c != a) mesh.triangles.push_back({a, b, c});
      if (a != c && c != d && d != a) mesh.triangles.push_back({a, c, d});
    }
  return mesh;
}

}  // namespace

TriangleMesh tessellated(const ConvexPart& part) {
  return tessellated(part, Grid());
}

TriangleMesh tessellated(const std::vector<ConvexPart>& parts) {
  constexpr std::size_t kMostFine = 200;
  const std::size_t step = (parts.size() + kMostParts - 1) / kMostParts;
  TriangleMesh whole;
  for (std::size_t i = 0; i < parts.size(); i += step) {
    const bool coarse = parts.size() > kMostFine && parts[i].radius > 0;
    const TriangleMesh one = tessellated(parts[i], coarse ? kCoarse : Grid());
    const auto first = static_cast<std::uint32_t>(whole.vertices.size());
    whole.vertices.insert(whole.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (const auto& t : one.triangles)
      whole.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return whole;
}

TriangleMesh flatSurface(const std::vector<ConvexPart>& pieces) {
  TriangleMesh mesh;
  for (const ConvexPart& piece : pieces) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), piece.points.begin(), piece.points.end());
    for (auto k = first + 2; k < mesh.vertices.size(); ++k) {
      mesh.triangles.push_back({first, k - 1, k});
      mesh.triangles.push_back({first, k, k - 1});
    }
  }
  return mesh;
}

TriangleMesh partsSurface(const PlacedShape& shape) {
  return shape.polygon.empty() ? tessellated(shape.parts) : flatSurface(shape.parts);
}

TriangleMesh coarsened(const TriangleMesh& mesh, double cell) {
  TriangleMesh coarse;
  std::map<std::tuple<double, double, double>, std::uint32_t> cells;
  std::vector<std::uint32_t> standIn;
  for (const Vec3& p : mesh.vertices) {
    const Vec3 at = (p / cell).array().floor();
    const auto [found, added] =
        cells.try_emplace({at.x(), at.y(), at.z()}, static_cast<std::uint32_t>(cells.size()));
    if (added) coarse.vertices.push_back(p);
    standIn.push_back(found->second);
  }
  for (const auto& t : mesh.triangles) {
    const std::uint32_t a = standIn[t[0]], b = standIn[t[1]], c = standIn[t[2]];
    if (a != b && b != c && c != a) coarse.triangles.push_back({a, b, c});
  }
  return coarse;
}

}  // namespace corridor::view
