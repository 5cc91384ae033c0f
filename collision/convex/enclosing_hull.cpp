#include "collision/convex/enclosing_hull.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "collision/convex/convex_distance.h"
#include "collision/core/rounding.h"
#include "collision/geometry/convex_part.h"
#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

constexpr std::size_t kMostVertices = 1024;
/// Cells along the longest side of the grid, at most.
constexpr int kMostCells = 40;
constexpr std::size_t kSampledTriangles = 256;
/// For `thinned`: hulls of more points are thinned; a part of their radius; and how many directions
/// choose the points with which it begins.
constexpr std::size_t kFewPoints = 200;
constexpr double kThinning = 1.0 / 1024;
constexpr int kDirections = 48;
constexpr double kGoldenAngle = 2.399963229728653;  // radians
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

/// The cells of a grid over a box, numbered along rows.
struct Grid {
  Vec3 lower;
  double edge = 0;
  Eigen::Array3i counts;

  std::size_t size() const { return static_cast<std::size_t>(counts.prod()); }
  std::size_t indexOf(const Eigen::Array3i& cell) const {
    return static_cast<std::size_t>((cell[0] * counts[1] + cell[1]) * counts[2] + cell[2]);
  }
};

/// Returns the centres of the cells that are the first or the last one with vertices in each of
/// their three rows.
std::vector<Vec3> outerCells(const Grid& grid, const std::vector<char>& isFull) {
  std::vector<char> isInside(grid.size());
  for (int axis = 0; axis < 3; ++axis) {
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    Eigen::Array3i cell;
    for (cell[second] = 0; cell[second] < grid.counts[second]; ++cell[second])
      for (cell[third] = 0; cell[third] < grid.counts[third]; ++cell[third]) {
        int first = -1, last = -1;
        for (cell[axis] = 0; cell[axis] < grid.counts[axis]; ++cell[axis])
          if (isFull[grid.indexOf(cell)]) {
            if (first < 0) first = cell[axis];
            last = cell[axis];
          }
        for (cell[axis] = first + 1; cell[axis] < last; ++cell[axis])
          isInside[grid.indexOf(cell)] = true;
      }
  }
  std::vector<Vec3> centers;
  Eigen::Array3i cell;
  for (cell[0] = 0; cell[0] < grid.counts[0]; ++cell[0])
    for (cell[1] = 0; cell[1] < grid.counts[1]; ++cell[1])
      for (cell[2] = 0; cell[2] < grid.counts[2]; ++cell[2])
        if (isFull[grid.indexOf(cell)] && !isInside[grid.indexOf(cell)])
          centers.emplace_back(grid.lower + grid.edge * (cell.cast<double>() + 0.5).matrix());
  return centers;
}

/// Returns the hull of cells with vertices, with as fine a grid as the number of points permits.
std::optional<EnclosingHull> hullOfCells(const TriangleMesh& mesh) {
  Grid grid;
  Vec3 upper = grid.lower = mesh.corner(0, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      grid.lower = grid.lower.cwiseMin(mesh.corner(t, k));
      upper = upper.cwiseMax(mesh.corner(t, k));
    }
  const Vec3 size = upper - grid.lower;
  for (int cells = kMostCells; cells >= 5; cells = cells * 3 / 4) {
    grid.edge = size.maxCoeff() / cells;
    if (!(grid.edge > 0)) return std::nullopt;
    const auto cellOf = [&](const Vec3& p) -> Eigen::Array3i {
      return ((p - grid.lower) / grid.edge).array().cast<int>();
    };
    grid.counts = cellOf(upper) + 1;
    std::vector<char> isFull(grid.size());
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t v : triangle) isFull[grid.indexOf(cellOf(mesh.vertices[v]))] = true;
    std::vector<Vec3> centers = outerCells(grid, isFull);
    if (centers.size() > kMostVertices) continue;
    // Half the diagonal of a cell, and the rounding of cells and centres: a few 2^-53 of the
    // coordinates.
    const double terms = grid.lower.lpNorm<1>() + upper.lpNorm<1>();
    return EnclosingHull{PointColumns(std::move(centers)),
                         roundedUp(0.8660254038 * grid.edge + 0x1p-48 * terms)};
  }
  return std::nullopt;
}

/// Returns whether triangles lie, on average, not far below the surface of the hull of the points.
bool fits(const EnclosingHull& hull, const TriangleMesh& mesh) {
  const PointColumns& points = hull.points;
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
    depths += normal.dot(points.points()[points.farthest(normal)] - a) + hull.radius * area;
  }
  return areas > 0 && depths < kDeepest * std::sqrt(square) * areas;
}

}  // namespace

std::optional<EnclosingHull> enclosingHull(const TriangleMesh& mesh) {
  std::vector<Vec3> used = usedVertices(mesh);
  std::optional<EnclosingHull> hull =
      used.empty() ? hullOfCells(mesh) : EnclosingHull{PointColumns(std::move(used))};
  if (hull && !fits(*hull, mesh)) hull.reset();
  return hull;
}

EnclosingHull thinned(EnclosingHull hull) {
  const PointColumns& all = hull.points;
  const std::span<const Vec3> points = all.points();
  if (points.size() <= kFewPoints) return hull;
  double square = 0;
  for (const Vec3& p : points) square = std::max(square, (p - all.center()).squaredNorm());
  const double tolerance = kThinning * std::sqrt(square);
  std::vector<char> isKept(points.size());
  for (int i = 0; i < kDirections; ++i) {  // of a Fibonacci sphere
    const double z = 1 - (2 * i + 1.0) / kDirections, turn = kGoldenAngle * i;
    const double r = std::sqrt(1 - z * z);
    isKept[all.farthest({r * std::cos(turn), r * std::sin(turn), z})] = true;
  }
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (isKept[i]) kept.push_back(points[i]);
  PointColumns columns(kept);
  ConvexPart point;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (isKept[i]) continue;
    point.points = {points[i]};
    const ConvexSet hullOfKept(columns);  // it only grows
    const ConvexRange range = convexDistanceRange({ConvexSet(point), Transform()},
                                                  {hullOfKept, Transform()}, tolerance, tolerance);
    if (range.upper <= tolerance) continue;
    kept.push_back(points[i]);
    columns = PointColumns(kept);
  }
  return {std::move(columns), roundedUp(hull.radius + tolerance)};
}

}  // namespace corridor
