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
using ScaledCorners = std::array<Point, 3>;

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

/// Returns the parameter s in [0, 1] of the point p + s·d that is closest to q; 0 if d vanishes.
Real nearest(const Point& p, const Point& d, const Point& q) {
  const Real square = dot(d, d);
  return square > Real(0) ? clamped(dot(d, q - p) / square) : Real(0);
}

/// Offers pairs of points of two edges as candidates for the closest pair: each end with the
/// closest point of the other edge, and the points where the common perpendicular meets the edges.
/// Uses cross products: for nearly parallel edges, the usual denominator |d|²|e|² − (d·e)² would
/// lose all digits. With cross products, the point on the first edge is off by 2^-98 divided by the
/// sine of the angle between the edges. The second point is the closest point to the first one, so
/// the distance is off by only 2^-98 of the coordinates.
void offerEdges(Best& best, const Point& p, const Point& p1, const Point& q, const Point& q1) {
  const Point d = p1 - p, e = q1 - q;
  const Point n = cross(d, e);
  const Real square = dot(n, n);
  if (square > Real(0)) {
    const Point at = p + d * clamped(dot(cross(e, p - q), n) / square);
    best.offer(at, q + e * nearest(q, e, at));
  }
  for (const Point& end : {p, p1}) best.offer(end, q + e * nearest(q, e, end));
  for (const Point& end : {q, q1}) best.offer(p + d * nearest(p, d, end), end);
}

/// Computes the foot of p: its orthogonal projection onto the plane of t. Returns whether the foot
/// lies inside t. Uses cross products, as `offerEdges` does, and repeats the step once from the
/// point found. Therefore the error for a sliver is relative to the sliver's height, not to the
/// coordinates.
bool foot(const Point& p, const ScaledCorners& t, Point& found) {
  const Point u = t[1] - t[0], v = t[2] - t[0], n = cross(u, v);
  const Real square = dot(n, n);
  if (!(square > Real(0))) return false;
  Real x(0), y(0);
  found = t[0];
  for (int i = 0; i < 2; ++i) {
    const Point w = p - found;
    x = x + dot(cross(w, v), n) / square;
    y = y + dot(cross(u, w), n) / square;
    found = t[0] + u * x + v * y;
  }
  return !(x < Real(0)) && !(y < Real(0)) && !(x + y > Real(1));
}

/// Offers q and its foot in t as a candidate if the foot lies inside t. `swapped` is true if q
/// belongs to the second triangle.
void offerFoot(Best& best, const Point& q, const ScaledCorners& t, bool swapped) {
  Point found;
  if (!foot(q, t, found)) return;
  swapped ? best.offer(found, q) : best.offer(q, found);
}

/// Offers as candidates the points where edges of p pass through the face of t. If two triangles
/// cross, at least one of them has an edge that passes through the other's face. `swapped` is true
/// if p is the second triangle.
void offerCrossings(Best& best, const ScaledCorners& p, const ScaledCorners& t, bool swapped) {
  const Point n = cross(t[1] - t[0], t[2] - t[0]);
  Real height[3];
  for (int i = 0; i < 3; ++i) height[i] = dot(n, p[i] - t[0]);
  for (int i = 0; i < 3; ++i) {
    const Real &h = height[i], &k = height[(i + 1) % 3];
    if (!(h < Real(0) && k > Real(0)) && !(h > Real(0) && k < Real(0))) continue;
    offerFoot(best, p[i] + (p[(i + 1) % 3] - p[i]) * (h / (h - k)), t, swapped);
  }
}

ScaledCorners mapped(const Triangle& t, const Transform& X, double unit) {
  ScaledCorners corners;
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

/// Distances below kZeroDistance units count as 0. The unit is at most S, the largest Σ|m||v| + |t|
/// of the mapped corners.
constexpr double kZeroDistance = 0x1p-56;

bool countsAsZero(const Best& best) {
  return best.square < Real(kZeroDistance * kZeroDistance);
}

/// Finds the two closest features in plain doubles, relative to one of the corners, and offers the
/// closest points of these features. Returns true if these points are proved to be the closest of
/// the triangles: the projections of both triangles onto the line through them are as far apart as
/// the points, up to kZeroDistance.
bool offerClosestFeatures(Best& best, const ScaledCorners& s, const ScaledCorners& t) {
  Triangle a, b;
  for (int i = 0; i < 3; ++i) {
    const Point p = s[i] - s[0], q = t[i] - s[0];
    a[i] = {p.x.hi, p.y.hi, p.z.hi};
    b[i] = {q.x.hi, q.y.hi, q.z.hi};
  }
  const int feature = closestFeaturePoints(a, b).feature;
  if (feature < 9) {
    const int i = feature / 3, k = feature % 3;
    offerEdges(best, s[i], s[(i + 1) % 3], t[k], t[(k + 1) % 3]);
  } else if (feature < 12) {
    offerFoot(best, t[feature - 9], s, true);
  } else {
    offerFoot(best, s[feature - 12], t, false);
  }
  if (!(best.square.hi < HUGE_VAL)) return false;  // double-double puts the foot outside the face
  if (countsAsZero(best)) return true;
  const Point n = best.b - best.a;
  const Real most =
      sqrt(best.square) * Real(kZeroDistance / 2);  // tolerance on each side, times |n|
  for (int i = 0; i < 3; ++i)
    if (!(dot(n, s[i] - best.a) < most) || !(-most < dot(n, t[i] - best.b))) return false;
  return true;
}

/// Returns the largest Σ|m||v| + |t| of the mapped corners.
double largestTerms(const Triangle& t, const Transform& X) {
  double size = 0;
  for (const Vec3& p : t)
    size = std::max(size, (X.m.cwiseAbs() * p.cwiseAbs() + X.t.cwiseAbs()).maxCoeff());
  return size;
}

Vec3 rounded(const Point& p, double unit) {
  return unit * Vec3(p.x.hi, p.y.hi, p.z.hi);
}

}  // namespace

WitnessPoints witnessPoints(const Triangle& a, const Transform& X_WA, const Triangle& b,
                            const Transform& X_WB) {
  const double unit = powerOfTwo(std::max(largestTerms(a, X_WA), largestTerms(b, X_WB)));
  const ScaledCorners s = mapped(a, X_WA, unit), t = mapped(b, X_WB, unit);
  Best best;
  const bool proved = offerClosestFeatures(best, s, t);
  if (!proved) {
    offerCrossings(best, s, t, false);
    offerCrossings(best, t, s, true);
  }
  if (!proved && !countsAsZero(best)) {
    for (int i = 0; i < 3; ++i) {
      offerFoot(best, t[i], s, true);
      offerFoot(best, s[i], t, false);
      for (int k = 0; k < 3; ++k) offerEdges(best, s[i], s[(i + 1) % 3], t[k], t[(k + 1) % 3]);
    }
  }
  // The error bound covers the tolerance of the proof, the rounding of double-double (2^-90 of the
  // unit), and the final rounding.
  const double distance = unit * sqrt(best.square).hi;
  return {rounded(best.a, unit), rounded(best.b, unit), distance,
          roundedUp(2 * kZeroDistance * unit + 2 * kUnit * distance)};
}

// Derivation of `error_`. A mapped corner takes at most 7 roundings, the division by `unit`
// included, of terms below S = ‖M‖_F·reach + |t|. It is off by 8u·√3·S < 14u·S. The difference of
// two corners is off by 14u(S_A + S_B). A projection onto n of a vector shorter than S_A + S_B, the
// error 4u of n itself, and the quotient add 10u·(S_A + S_B). The same bound holds for a distance.
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
  // Far below the unit, squares underflow; then only the lower bound 0 is certain.
  if (length > 0x1p-400) range.lower = std::max(0.0, unit_ * (gap / length) - error_);
  if (!(range.upper >= 0)) range.upper = HUGE_VAL;  // NaN: nothing is known
  return range;
}

}  // namespace corridor
