#pragma once

#include <span>
#include <vector>

#include "collision/core/transform.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// A closed ball; a point where the radius is 0. Metres.
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

/// What a volume is put around: the hull of triangles, or of balls. A look; what it looks at must
/// stay. Not empty.
struct Content {
  std::span<const Triangle> triangles;
  std::span<const Ball> balls;

  Content(std::span<const Triangle> t) : triangles(t) {}  // NOLINT: triangles are content
  Content(std::span<const Ball> b) : balls(b) {}          // NOLINT: balls are content

  Content(const std::vector<Triangle>& t) : triangles(t) {}  // NOLINT
  Content(const std::vector<Ball>& b) : balls(b) {}          // NOLINT

  /// f(point, radius) of all corners and balls: a convex set that holds these holds all.
  template <class F>
  void forEach(F&& f) const {
    for (const Triangle& t : triangles)
      for (const Vec3& p : t) f(p, 0.0);
    for (const Ball& b : balls) f(b.center, b.radius);
  }
  const Vec3& anyPoint() const { return balls.empty() ? triangles[0][0] : balls[0].center; }
};

}  // namespace corridor
