#include "collision/queries/distance_triangle_triangle.h"

#include <algorithm>
#include <limits>

namespace corridor {
namespace {

void offer(ClosestPoints& best, const Vec3& a, const Vec3& b, int feature) {
  const double d = (b - a).squaredNorm();
  // A degenerate feature may give a NaN, for which the condition is false.
  if (d < best.squaredDistance) best = {a, b, d, feature};
}

double clamped(double x) {
  return x > 0 ? std::min(x, 1.0) : 0;
}

void offerEdges(ClosestPoints& best, const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2,
                int feature) {
  const Vec3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r), c = d1.dot(r),
               b = d1.dot(d2);
  const double denominator = a * e - b * b;
  // For parallel edges, s = 0 is only a start: if t is clamped below, s is computed again. If the
  // second edge is a point, s belongs to the point of the first edge that is closest to it.
  double s = denominator > 0     ? clamped((b * f - c * e) / denominator)
             : !(e > 0) && a > 0 ? clamped(-c / a)
                                 : 0;
  double t = e > 0 ? (b * s + f) / e : 0;
  if (!(t >= 0 && t <= 1)) {
    t = clamped(t);
    s = a > 0 ? clamped((b * t - c) / a) : 0;
  }
  offer(best, p1 + s * d1, p2 + t * d2, feature);
}

/// Computes the foot of p: its orthogonal projection onto the plane of t. Returns whether the foot
/// lies inside t. `offerEdges` covers the edges and corners of t.
bool footInside(const Vec3& p, const Triangle& t, Vec3& foot) {
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], w = p - t[0];
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), wu = w.dot(u),
               wv = w.dot(v);
  const double denominator = uu * vv - uv * uv;
  if (!(denominator > 0)) return false;
  const double x = (vv * wu - uv * wv) / denominator, y = (uu * wv - uv * wu) / denominator;
  if (!(x >= 0 && y >= 0 && x + y <= 1)) return false;
  foot = t[0] + x * u + y * v;
  return true;
}

}  // namespace

ClosestPoints closestFeaturePoints(const Triangle& a, const Triangle& b) {
  ClosestPoints best{a[0], b[0], std::numeric_limits<double>::infinity(), 0};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      offerEdges(best, a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3], 3 * i + k);
  Vec3 foot;
  for (int i = 0; i < 3; ++i) {
    if (footInside(b[i], a, foot)) offer(best, foot, b[i], 9 + i);
    if (footInside(a[i], b, foot)) offer(best, a[i], foot, 12 + i);
  }
  return best;
}

}  // namespace corridor
