#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"

/// Oracles for convex sets. They compute in long double, by other formulas than the code under
/// test.
namespace corridor::test {

using Vec3L = Eigen::Matrix<long double, 3, 1>;
using Mat3L = Eigen::Matrix<long double, 3, 3>;

inline long double toSegment(const Vec3L& p, const Vec3L& a, const Vec3L& b) {
  const Vec3L d = b - a;
  const long double square = d.squaredNorm();
  const long double s = square > 0 ? std::clamp(d.dot(p - a) / square, 0.0L, 1.0L) : 0.0L;
  return (p - a - s * d).norm();
}

inline long double toTriangle(const Vec3L& p, const Vec3L& a, const Vec3L& b, const Vec3L& c) {
  const Vec3L n = (b - a).cross(c - a);
  const auto left = [&](const Vec3L& from, const Vec3L& to) {
    return n.dot((to - from).cross(p - from)) >= 0;
  };
  long double best = std::min({toSegment(p, a, b), toSegment(p, b, c), toSegment(p, c, a)});
  if (n.squaredNorm() > 0 && left(a, b) && left(b, c) && left(c, a))
    best = std::min(best, std::abs(n.dot(p - a)) / n.norm());
  return best;
}

/// Returns the distance of point q from a convex part, both in the part's frame. For a hull of four
/// points or more, this is the distance from the nearest triangle of any three of its points, which
/// may be above 0 if q is inside the hull. For any other part, the result is 0 if q is inside.
inline long double outside(const ConvexPart& part, const Vec3L& q) {
  const auto at = [&](std::size_t i) -> Vec3L { return part.points[i].cast<long double>(); };
  const std::size_t n = part.points.size();
  if (part.flatEnds) {
    const Vec3L center = (at(0) + at(1)) / 2, d = at(1) - at(0), u = d.normalized();
    const long double z = std::abs(u.dot(q - center)) - d.norm() / 2,
                      r = (q - center - u * u.dot(q - center)).norm() - part.radius;
    return std::hypot(std::max(0.0L, z), std::max(0.0L, r));
  }
  long double core = HUGE_VALL;
  if (n == 1) core = (q - at(0)).norm();
  if (n == 2) core = toSegment(q, at(0), at(1));
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < i; ++k)
      for (std::size_t l = 0; l < k; ++l) core = std::min(core, toTriangle(q, at(i), at(k), at(l)));
  return std::max(0.0L, core - part.radius);
}

/// Returns the distance of a point in the world from a part under the map X, which must be rigid up
/// to rounding. A point inside the part is treated as in the function above.
inline long double outside(const ConvexPart& part, const Transform& X, const Vec3& p_W) {
  return outside(part, X.m.cast<long double>().transpose() *
                           (p_W.cast<long double>() - X.t.cast<long double>()));
}

/// Returns the largest n·x over all points x of the image of a part under any affine map.
inline long double highest(const ConvexPart& part, const Transform& X, const Vec3L& n) {
  const Vec3L m = X.m.cast<long double>().transpose() * n;
  long double most = -HUGE_VALL;
  for (const Vec3& p : part.points) most = std::max(most, m.dot(p.cast<long double>()));
  long double across = m.norm();
  if (part.flatEnds)
    across = m.cross((part.points[1] - part.points[0]).cast<long double>().normalized()).norm();
  return most + part.radius * across + n.dot(X.t.cast<long double>());
}

}  // namespace corridor::test
