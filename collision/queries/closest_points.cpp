#include "collision/queries/closest_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/convex/double_double.h"
#include "collision/convex/simplex.h"
#include "collision/core/rounding.h"
#include "collision/queries/distance_triangle_triangle.h"

namespace corridor {
namespace {

using Real = DoubleDouble;
using Point = gjk::Vector<Real>;
using Corners = std::array<Point, 3>;

struct Best {
  Point a, b;
  Real square = HUGE_VAL;

  void offer(const Point& p, const Point& q) {
    const Point d = q - p;
    const Real s = dot(d, d);
    if (s < square) *this = {p, q, s};
  }
};

Real clamped(const Real& x) {
  return x > Real(0) ? (x < Real(1) ? x : Real(1)) : Real(0);
}

/// The point of the segment p + s·d next to q; p where d vanishes.
Real nearest(const Point& p, const Point& d, const Point& q) {
  const Real square = dot(d, d);
  return square > Real(0) ? clamped(dot(d, q - p) / square) : Real(0);
}

void offerEdges(Best& best, const Point& p, const Point& p1, const Point& q, const Point& q1) {
  const Point d = p1 - p, e = q1 - q, r = p - q;
  const Real a = dot(d, d), b = dot(d, e), c = dot(d, r), f = dot(e, r), g = dot(e, e);
  const Real det = a * g - b * b;
  Real s = det > Real(0) ? clamped((b * f - c * g) / det) : Real(0);
  // Each in turn the best for the other: settles the ends, and what nearly parallel edges lose.
  for (int i = 0; i < 2; ++i) {
    const Real t = nearest(q, e, p + d * s);
    best.offer(p + d * s, q + e * t);
    s = nearest(p, d, q + e * t);
  }
}

/// The foot of p in the plane of t, where it is inside.
bool foot(const Point& p, const Corners& t, Point& found) {
  const Point u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const Real uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), wu = dot(w, u), wv = dot(w, v);
  const Real det = uu * vv - uv * uv;
  if (!(det > Real(0))) return false;
  const Real x = (vv * wu - uv * wv) / det, y = (uu * wv - uv * wu) / det;
  if (x < Real(0) || y < Real(0) || x + y > Real(1)) return false;
  found = t[0] + u * x + v * y;
  return true;
}

/// Corners over the face of t, and edges through it. `swapped`: p is of the second triangle.
void offerFace(Best& best, const Corners& p, const Corners& t, bool swapped) {
  const Point n = cross(t[1] - t[0], t[2] - t[0]);
  Real height[3];
  const auto offer = [&](const Point& q) {
    Point found;
    if (!foot(q, t, found)) return;
    swapped ? best.offer(found, q) : best.offer(q, found);
  };
  for (int i = 0; i < 3; ++i) {
    offer(p[i]);
    height[i] = dot(n, p[i] - t[0]);
  }
  for (int i = 0; i < 3; ++i) {
    const Real &h = height[i], &k = height[(i + 1) % 3];
    if (!(h < Real(0) && k > Real(0)) && !(h > Real(0) && k < Real(0))) continue;
    offer(p[i] + (p[(i + 1) % 3] - p[i]) * (h / (h - k)));
  }
}

Corners mapped(const Triangle& t, const Transform& X, double unit) {
  Corners corners;
  for (int k = 0; k < 3; ++k) {
    Real c[3];
    for (int i = 0; i < 3; ++i) {
      c[i] = X.t[i] / unit;
      for (int j = 0; j < 3; ++j) c[i] = c[i] + DoubleDouble::product(X.m(i, j), t[k][j] / unit);
    }
    corners[k] = {c[0], c[1], c[2]};
  }
  return corners;
}

double powerOfTwo(double size) {
  return std::ldexp(1.0, std::clamp(std::ilogb(size), -1000, 1000));
}

Vec3 rounded(const Point& p, double unit) {
  return unit * Vec3(p.x.hi, p.y.hi, p.z.hi);
}

}  // namespace

WitnessPoints closestPoints(const Triangle& a, const Transform& X_WA, const Triangle& b,
                            const Transform& X_WB) {
  double size = std::max(X_WA.t.cwiseAbs().maxCoeff(), X_WB.t.cwiseAbs().maxCoeff());
  for (const Triangle* t : {&a, &b})
    for (const Vec3& p : *t) size = std::max(size, p.cwiseAbs().maxCoeff());
  const double unit = powerOfTwo(size);
  const Corners s = mapped(a, X_WA, unit), t = mapped(b, X_WB, unit);
  Best best;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) offerEdges(best, s[i], s[(i + 1) % 3], t[k], t[(k + 1) % 3]);
  offerFace(best, s, t, false);
  offerFace(best, t, s, true);
  return {rounded(best.a, unit), rounded(best.b, unit), unit * sqrt(best.square).hi};
}

// A mapped corner: 7 roundings with that of `unit` at most, of terms below S = ‖M‖_F·reach + |t|,
// so 8u·√3·S < 14u·S. Both corners of a difference: 14u(S_A + S_B); a projection onto n of what is
// below S_A + S_B, with n's own 4u, and the quotient: 10u more. Likewise a distance.
TriangleDistances::TriangleDistances(const Transform& X_WA, double reachA, const Transform& X_WB,
                                     double reachB)
    : X_WA_(X_WA), X_WB_(X_WB) {
  const double size =
      X_WA.m.norm() * reachA + X_WA.t.stableNorm() + X_WB.m.norm() * reachB + X_WB.t.stableNorm();
  unit_ = powerOfTwo(size);
  error_ = roundedUp(32 * kUnit * size);
}

DistanceRange TriangleDistances::operator()(const Triangle& a, const Triangle& b) const {
  Triangle s, t;
  for (int i = 0; i < 3; ++i) {
    s[i] = (X_WA_ * a[i]) / unit_;
    t[i] = (X_WB_ * b[i]) / unit_;
  }
  const ClosestPoints closest = closestFeaturePoints(s, t);
  const Vec3 n = closest.b - closest.a;
  const double length = n.norm();
  const double gap = std::min({n.dot(t[0]), n.dot(t[1]), n.dot(t[2])}) -
                     std::max({n.dot(s[0]), n.dot(s[1]), n.dot(s[2])});
  DistanceRange range{0, unit_ * length + error_};
  // Far below the unit squares vanish, and all that is known is `error_`.
  if (length > 0x1p-400) range.lower = std::max(0.0, unit_ * (gap / length) - error_);
  if (!(range.upper >= 0)) range.upper = HUGE_VAL;  // NaN: nothing is known
  return range;
}

}  // namespace corridor
