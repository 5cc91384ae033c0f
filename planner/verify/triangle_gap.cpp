#include "planner/verify/triangle_gap.h"

#include <algorithm>
#include <cmath>

namespace corridor::verify {
namespace {

Real clampToUnit(Real x) {
  return std::clamp<Real>(x, 0, 1);
}

void keepCloser(DistanceBounds& best, const RealVec& onA, const RealVec& onB) {
  const Real square = (onB - onA).squaredNorm();
  if (square < best.upper) best = {0, square, onA, onB};  // `upper` holds squares until the end
}

/// Tries the closest points p + t·d1 and r + u·d2 of two segments (Ericson, Real-Time Collision
/// Detection, 5.1.9). If the segments are nearly parallel, rounding may make the first value of t
/// arbitrary. So the best u is computed for this t, and then the best t for this u.
void edgeEdge(DistanceBounds& best, const RealVec& p, const RealVec& q, const RealVec& r,
              const RealVec& s) {
  const RealVec d1 = q - p, d2 = s - r, w = p - r;
  const Real a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(w), c = d1.dot(w);
  const Real b = d1.dot(d2), determinant = a * e - b * b;
  const Real firstT = determinant > 0 ? clampToUnit((b * f - c * e) / determinant) : 0;
  const Real u = e > 0 ? clampToUnit((b * firstT + f) / e) : 0;
  const Real t = a > 0 ? clampToUnit((b * u - c) / a) : 0;
  keepCloser(best, p + t * d1, r + u * d2);
}

/// If the orthogonal projection of `p` onto the plane of the triangle `t` is inside the triangle,
/// sets `foot` to this projection. @returns whether it is inside.
bool footInside(const RealVec& p, const RealVec t[3], RealVec& foot) {
  const RealVec normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const Real square = normal.squaredNorm();
  if (!(square > 0)) return false;
  for (int i = 0; i < 3; ++i) {
    if (normal.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) < 0) return false;
  }
  foot = p - (normal.dot(p - t[0]) / square) * normal;
  return true;
}

/// Returns the width of the widest slab along these directions: the normals of the triangles, the
/// cross products of their edges, and the normals of edges in the planes of the triangles. These
/// slabs are needed for triangles that are so thin that their computed closest points are wrong.
Real widestSlab(const RealVec a[3], const RealVec b[3]) {
  const RealVec normalA = (a[1] - a[0]).cross(a[2] - a[0]);
  const RealVec normalB = (b[1] - b[0]).cross(b[2] - b[0]);
  Real widest = 0;
  const auto consider = [&](const RealVec& n) {
    widest = std::max({widest, slabWidth(a, b, n), slabWidth(a, b, -n)});
  };
  consider(normalA);
  consider(normalB);
  for (int i = 0; i < 3; ++i) {
    const RealVec edgeA = a[(i + 1) % 3] - a[i];
    consider(edgeA.cross(normalA));
    for (int j = 0; j < 3; ++j) {
      const RealVec edgeB = b[(j + 1) % 3] - b[j];
      consider(edgeA.cross(edgeB));
      if (i == 0) consider(edgeB.cross(normalB));
    }
  }
  return widest;
}

}  // namespace

Real slabWidth(const RealVec a[3], const RealVec b[3], const RealVec& direction) {
  const Real length = direction.norm();
  if (!(length > 0)) return 0;
  const Real nearA = std::max({direction.dot(a[0]), direction.dot(a[1]), direction.dot(a[2])});
  const Real nearB = std::min({direction.dot(b[0]), direction.dot(b[1]), direction.dot(b[2])});
  return (nearB - nearA) / length;
}

DistanceBounds triangleGap(const RealVec a[3], const RealVec b[3]) {
  DistanceBounds best;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) edgeEdge(best, a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
    RealVec foot;
    if (footInside(a[i], b, foot)) keepCloser(best, a[i], foot);
    if (footInside(b[i], a, foot)) keepCloser(best, foot, b[i]);
  }
  best.upper = std::sqrt(best.upper);
  best.lower = std::max<Real>(0, slabWidth(a, b, best.onB - best.onA));
  // In the best direction the width of the slab is the distance. The threshold 1/1024 only decides
  // whether a second attempt is worth its time.
  if (best.lower < best.upper * (1 - Real(1) / 1024)) {
    best.lower = std::max(best.lower, widestSlab(a, b));
  }
  return best;
}

}  // namespace corridor::verify
