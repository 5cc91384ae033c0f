#include "collision/convex/enclosing_hull.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include <Eigen/Geometry>

#include "collision/convex/gjk.h"
#include "collision/core/rounding.h"
#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

constexpr std::size_t kAllVertices = 400;    // of so many vertices, none is left out
constexpr std::size_t kMostVertices = 4096;  // building a hull of more takes longer than a tree
constexpr std::size_t kMostHullPoints = 400;
/// Vertices that are so near to the hull of the others are not chosen, as a part of the radius.
constexpr double kNear = 1e-3;
constexpr int kDirections = 192;
constexpr std::size_t kSampledTriangles = 256;
constexpr double kDeepest = 0.35;  // mean depth of the triangles, as a part of the mesh's radius

/// Returns the distinct vertices that the triangles use.
std::vector<Vec3> usedVertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) used[v] = true;
  VertexWelder points(mesh.vertices.size());
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) points.addOrFind(mesh.vertices[v]);
  return points.takePoints();
}

/// Returns the points that are farthest in directions that are spread evenly (Fibonacci's spiral).
std::vector<Vec3> extremePoints(const PointColumns& all) {
  std::set<std::uint32_t> chosen;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
    chosen.insert(all.farthest({r * std::cos(i * golden), r * std::sin(i * golden), z}));
  }
  std::vector<Vec3> points;
  for (const std::uint32_t i : chosen) points.push_back(all.points()[i]);
  return points;
}

/// Returns the radius of the points about their mean, metres.
double radiusOf(const PointColumns& points) {
  double square = 0;
  for (const Vec3& p : points.points())
    square = std::max(square, (p - points.center()).squaredNorm());
  return std::sqrt(square);
}

/// Returns whether triangles lie, on average, not far below the surface of the hull of the points.
bool fits(const PointColumns& points, double radius, const TriangleMesh& mesh) {
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
  return areas > 0 && depths < kDeepest * radius * areas;
}

/// Bounds the distances of points from a hull by GJK. Each search begins where the last one ended:
/// vertices that follow each other are mostly near each other.
class DistanceFromHull {
 public:
  explicit DistanceFromHull(const PointColumns& hull) : hull_(ConvexSet(hull), {}) {}

  /// Returns an upper bound of the distance, metres. The search ends when the bound is at most
  /// `enough`, or the distance is above `beyond`.
  ///
  /// Rounding. `Answer::upper` is the distance of p from a convex combination of points, whose
  /// weights are off by a few u. So it is off by less than 2^-44 of the largest coordinate.
  double above(const Vec3& p, double enough, double beyond) {
    one_.points.front() = p;
    const PosedSet point(one_, {});
    const double size = point.reach() + hull_.reach();
    gjk::Search<double> search(point, hull_, size);
    const gjk::Answer found = search.run(
        gjk::startOf<double>(&cache_),
        [&](double upper, double lower) {
          return upper <= enough || lower > beyond || upper - lower <= 0x1p-40 * size;
        },
        [](const Vec3&, double, std::uint32_t, std::uint32_t) { return false; });
    gjk::keep(search.simplex, &cache_);
    return found.overlap ? 0 : found.upper + 0x1p-44 * size;
  }

 private:
  PosedSet hull_;
  ConvexPart one_{{Vec3::Zero()}, 0, false};
  ConvexCache cache_;
};

/// Returns the hull of `points` and of the vertices that are farther than `near` from it, swept by
/// the largest distance of the others. If there are too many vertices, the farthest ones are
/// chosen.
EnclosingHull around(const PointColumns& points, double near, std::span<const Vec3> all) {
  struct Outside {
    Vec3 point;
    double distance;  // from the hull of `points`, an upper bound
  };
  std::vector<Outside> outside;
  double largest = 0;  // distance of a vertex that is not chosen
  DistanceFromHull distance(points);
  for (const Vec3& p : all)
    if (const double above = distance.above(p, near, near); above > near)
      outside.push_back({p, above});
    else
      largest = std::max(largest, above);
  std::vector<Vec3> chosen(points.points().begin(), points.points().end());
  if (chosen.size() + outside.size() > kMostHullPoints) {
    for (Outside& each : outside) each.distance = distance.above(each.point, 0, HUGE_VAL);
    std::stable_sort(outside.begin(), outside.end(),
                     [](const Outside& a, const Outside& b) { return a.distance > b.distance; });
  }
  for (const Outside& each : outside)
    if (chosen.size() < kMostHullPoints)
      chosen.push_back(each.point);
    else
      largest = std::max(largest, each.distance);
  return {PointColumns(std::move(chosen)), roundedUp(largest)};
}

}  // namespace

std::optional<EnclosingHull> enclosingHull(const TriangleMesh& mesh) {
  PointColumns all(usedVertices(mesh));
  if (all.points().size() > kMostVertices) return std::nullopt;
  const bool isSmall = all.points().size() <= kAllVertices;
  const PointColumns points = isSmall ? all : PointColumns(extremePoints(all));
  const double radius = radiusOf(points);
  if (!fits(points, radius, mesh)) return std::nullopt;
  if (isSmall) return EnclosingHull{std::move(all), 0};
  return around(points, kNear * radius, all.points());
}

}  // namespace corridor
