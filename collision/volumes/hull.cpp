#include "collision/volumes/hull.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "collision/convex/convex_polygon.h"
#include "collision/convex/quickhull.h"
#include "collision/core/rounding.h"
#include "collision/volumes/bounding_sphere.h"

namespace corridor {
namespace {

bool isBefore(const Vec3& p, const Vec3& q) {
  return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
}
bool isBefore2(const Vec2& p, const Vec2& q) {
  return std::pair(p[0], p[1]) < std::pair(q[0], q[1]);
}

/// Returns the corners of the hull of points on one plane: the points whose images on a coordinate
/// plane are corners of the hull of all images. This finds all corners if the plane of the points
/// is not orthogonal to the coordinate plane. Otherwise the image is on one line, and the next
/// coordinate plane is tried.
std::vector<Vec3> flatVertices(const std::vector<Vec3>& points) {
  for (int dropped = 0; dropped < 3; ++dropped) {
    const auto image = [&](const Vec3& p) {
      return Vec2(p[(dropped + 1) % 3], p[(dropped + 2) % 3]);
    };
    std::vector<Vec2> images;
    for (const Vec3& p : points) images.push_back(image(p));
    try {
      const ConvexPolygon polygon(images);
      std::vector<Vec2> corners(polygon.vertices().begin(), polygon.vertices().end());
      std::sort(corners.begin(), corners.end(), isBefore2);
      std::vector<Vec3> kept;
      for (const Vec3& p : points)
        if (std::binary_search(corners.begin(), corners.end(), image(p), isBefore2))
          kept.push_back(p);
      return kept;
    } catch (const std::invalid_argument&) {  // on one line
    }
  }
  return {points.front(), points.back()};  // all are on one line, in lexicographic order
}

/// Returns the swept hull of the points with a sphere around it.
Hull hullOf(std::vector<Vec3> points, double size) {
  Hull hull;
  hull.vertices = hullVertices(std::move(points));
  hull.size = size;
  std::vector<Ball> balls;
  for (const Vec3& v : hull.vertices) balls.push_back({v});
  const BoundingSphere sphere =
      BoundingSphere::around(enclosingObb(balls, Mat3::Identity()), balls);
  hull.boundingCenter = sphere.center;
  hull.boundingRadius = roundedUp(sphere.size + size);
  return hull;
}

}  // namespace

std::vector<Vec3> hullVertices(std::vector<Vec3> points) {
  std::sort(points.begin(), points.end(), isBefore);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() <= 3) return points;
  const auto faces = quickhull(points);
  if (faces.empty()) return flatVertices(points);
  std::vector<char> used(points.size(), 0);
  for (const auto& face : faces)
    for (const std::uint32_t v : face) used[v] = 1;
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (used[i]) kept.push_back(points[i]);
  return kept;
}

Hull Hull::around(const Obb&, const Content& content) {
  std::vector<Vec3> points;
  double size = 0;
  content.forEach([&](const Vec3& p, double r) {
    points.push_back(p);
    size = std::max(size, r);
  });
  return hullOf(std::move(points), size);
}

Hull Hull::merged(const Hull& a, const Hull& b) {
  std::vector<Vec3> points = a.vertices;
  points.insert(points.end(), b.vertices.begin(), b.vertices.end());
  return hullOf(std::move(points), std::max(a.size, b.size));
}

double Hull::centerReach() const {
  double farthest = boundingCenter.stableNorm();
  for (const Vec3& v : vertices) farthest = std::max(farthest, v.stableNorm());
  return roundedUp(farthest);
}

}  // namespace corridor
