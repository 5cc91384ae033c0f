#pragma once

#include <span>
#include <vector>

#include "collision/core/transform.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// A solid sphere: all points at most `radius` from `center`. If the radius is 0, it is a point.
/// Metres.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

/// The set that a volume must contain: each of some triangles, or the convex hull of solid spheres
/// (`Ball`). Never empty. The object does not own the triangles or spheres, so these must outlive
/// it.
struct Content {
  std::span<const Triangle> triangles;
  std::span<const Ball> balls;

  Content(std::span<const Triangle> t) : triangles(t) {}  // NOLINT: triangles are content
  Content(std::span<const Ball> b) : balls(b) {}          // NOLINT: spheres are content

  Content(const std::vector<Triangle>& t) : triangles(t) {}  // NOLINT
  Content(const std::vector<Ball>& b) : balls(b) {}          // NOLINT

  /// Calls f(point, radius) for every corner (radius 0) and every sphere. A convex set that
  /// contains all these corners and spheres contains the content.
  template <class F>
  void forEach(F&& f) const {
    for (const Triangle& t : triangles)
      for (const Vec3& p : t) f(p, 0.0);
    for (const Ball& b : balls) f(b.center, b.radius);
  }
  const Vec3& anyPoint() const { return balls.empty() ? triangles[0][0] : balls[0].center; }
};

}  // namespace corridor
