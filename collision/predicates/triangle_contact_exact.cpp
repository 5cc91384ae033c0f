#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "collision/predicates/exact_number.h"
#include "collision/predicates/triangle_contact.h"

namespace corridor {
namespace {

using exact::coordinate;
using exact::cross;
using exact::dot;
using exact::dropAxis;
using exact::sign;
using exact::TriangleCorners;
using exact::Vector;

/// Returns the sign of the area of (p, q, r) projected along axis `drop`.
template <class Int>
int orientation2(const Vector<Int>& p, const Vector<Int>& q, const Vector<Int>& r, int drop) {
  return sign(coordinate(cross(q - p, r - p), drop));
}

template <class Int>
bool rangesMeet(const Int& a, const Int& b, const Int& c, const Int& d) {
  return std::max(a, b) >= std::min(c, d) && std::max(c, d) >= std::min(a, b);
}

/// Returns whether two closed segments pq and rs share a point. Each segment may be a point.
template <class Int>
bool segmentsTouch(const Vector<Int>& p, const Vector<Int>& q, const Vector<Int>& r,
                   const Vector<Int>& s) {
  const Vector<Int> d = q - p, e = s - r, f = r - p;
  const auto n = cross(d, e);
  // Segments that are not parallel meet if and only if they are coplanar and their projections
  // along axis `drop` meet.
  if (!n.isZero()) {
    if (sign(dot(n, f)) != 0) return false;
    const int drop = dropAxis(n);
    return orientation2(p, q, r, drop) * orientation2(p, q, s, drop) <= 0 &&
           orientation2(r, s, p, drop) * orientation2(r, s, q, drop) <= 0;
  }
  const Vector<Int>& line = d.isZero() ? e : d;
  if (!cross(line, f).isZero()) return false;
  // The segments are on one line, or both are points. Then they meet if and only if their
  // axis-aligned boxes do.
  return rangesMeet(p.x, q.x, r.x, s.x) && rangesMeet(p.y, q.y, r.y, s.y) &&
         rangesMeet(p.z, q.z, r.z, s.z);
}

/// Returns whether the closed segment pq and the closed triangle t share a point. n is the normal
/// of t: zero if t is degenerate.
template <class Int, class Product>
bool segmentTouchesTriangle(const Vector<Int>& p, const Vector<Int>& q,
                            const TriangleCorners<Int>& t, const Vector<Product>& n) {
  if (n.isZero()) {  // t is a segment or a point: the union of its edges
    for (int i = 0; i < 3; ++i)
      if (segmentsTouch(p, q, t[i], t[(i + 1) % 3])) return true;
    return false;
  }
  const int sideP = sign(dot(n, p - t[0])), sideQ = sign(dot(n, q - t[0]));
  if (sideP * sideQ > 0) return false;
  if (sideP == 0 && sideQ == 0) {  // in the triangle's plane
    for (int i = 0; i < 3; ++i)
      if (segmentsTouch(p, q, t[i], t[(i + 1) % 3])) return true;
    const int drop = dropAxis(n);
    const int turn = orientation2(t[0], t[1], t[2], drop);
    for (int i = 0; i < 3; ++i)
      if (orientation2(t[i], t[(i + 1) % 3], p, drop) * turn < 0) return false;
    return true;
  }
  // The segment crosses the plane in one point. That point is in the triangle, unless the segment
  // passes one edge on the left and another edge on the right.
  bool positive = false, negative = false;
  const Vector<Int> d = q - p;
  for (int i = 0; i < 3; ++i) {
    const int s = sign(dot(d, cross(t[i] - p, t[(i + 1) % 3] - p)));
    positive |= s > 0;
    negative |= s < 0;
  }
  return !(positive && negative);
}

template <class Int, class Product>
bool strictlyOneSide(const TriangleCorners<Int>& plane, const Vector<Product>& n,
                     const TriangleCorners<Int>& points) {
  const int s = sign(dot(n, points[0] - plane[0]));
  return s != 0 && s == sign(dot(n, points[1] - plane[0])) &&
         s == sign(dot(n, points[2] - plane[0]));
}

/// Returns whether two triangles share a point. They do if and only if an edge of one triangle
/// meets the other triangle, because an extreme point of their intersection lies on the boundary of
/// one of them. (A degenerate triangle consists of its boundary only.)
template <class Int>
bool touch(const TriangleCorners<Int>& a, const TriangleCorners<Int>& b) {
  const auto nA = cross(a[1] - a[0], a[2] - a[0]), nB = cross(b[1] - b[0], b[2] - b[0]);
  if (strictlyOneSide(a, nA, b) || strictlyOneSide(b, nB, a)) return false;
  for (int i = 0; i < 3; ++i)
    if (segmentTouchesTriangle(a[i], a[(i + 1) % 3], b, nB) ||
        segmentTouchesTriangle(b[i], b[(i + 1) % 3], a, nA))
      return true;
  return false;
}

template <class Int>
bool touch(const exact::MappedPoints& a, const exact::MappedPoints& b, const exact::Grid& grid) {
  return touch<Int>(exact::mapped<Int>(a, grid), exact::mapped<Int>(b, grid));
}

/// Returns whether two arrays are equal up to signs. Compares bits, because == treats subnormals as
/// zeros if the processor flushes them.
template <class Array>
bool equalUpToSigns(const Array& x, const Array& y) {
  std::uint64_t different = 0;
  for (Eigen::Index i = 0; i < Array::SizeAtCompileTime; ++i)
    different |= std::bit_cast<std::uint64_t>(x(i)) ^ std::bit_cast<std::uint64_t>(y(i));
  return different << 1 == 0;
}

/// Computes in doubles whether two triangles share a point. Returns nullopt if this computation may
/// not be exact. It is exact if the entries of both maps' matrices are 0 or ±1, as for quarter
/// turns, and all coordinates are on a coarse grid. Most triangles that touch by construction are
/// of this kind.
std::optional<bool> touchInDoubles(const Triangle& a, const Transform& X_WA, const Triangle& b,
                                   const Transform& X_WB) {
  double size = 0;
  for (const Transform* X : {&X_WA, &X_WB}) {
    if (!equalUpToSigns<Mat3>(X->m.cwiseAbs2(), X->m)) return std::nullopt;
    size = std::max(size, X->t.cwiseAbs().maxCoeff());
  }
  for (const Triangle* t : {&a, &b})
    for (const Vec3& p : *t) size = std::max(size, p.cwiseAbs().maxCoeff());
  // Entries of m are 0 or ±1. Let corners and translations be whole multiples, below 2^13, of a
  // power of two. In this unit mapped corners are below 2^15, differences below 2^16, and
  // orientations below 6·2^48 < 2^51. All of these numbers and all partial sums are exact, and
  // nothing underflows.
  if (!(size > 0x1p-250 && size < 0x1p250)) return std::nullopt;
  // Adding and subtracting 3·2^51 units rounds to whole units.
  const double rounder = std::ldexp(3.0, std::ilogb(size) - 12 + 51);
  const auto whole = [&](const Vec3& p) {
    return equalUpToSigns<Vec3>((p.array() + rounder) - rounder, p);
  };
  const auto mapped = [&](const Triangle& t, const Transform& X) {
    TriangleCorners<exact::Int53> points;
    for (int i = 0; i < 3; ++i) {
      const Vec3 p = X * t[i];
      points[i] = {exact::Int53(p[0]), exact::Int53(p[1]), exact::Int53(p[2])};
    }
    return points;
  };
  if (!whole(X_WA.t) || !whole(X_WB.t)) return std::nullopt;
  for (int i = 0; i < 3; ++i)
    if (!whole(a[i]) || !whole(b[i])) return std::nullopt;
  return touch(mapped(a, X_WA), mapped(b, X_WB));
}

bool areFinite(const Triangle& corners, const Transform& X) {
  return X.isFinite() && std::all_of(corners.begin(), corners.end(),
                                     [](const Vec3& corner) { return corner.allFinite(); });
}

}  // namespace

bool trianglesTouchExact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB) {
  if (!areFinite(a, X_WA) || !areFinite(b, X_WB)) return true;  // a NaN proves nothing
  if (const auto known = touchInDoubles(a, X_WA, b, X_WB)) return *known;
  const exact::MappedPoints cornersA(X_WA, a), cornersB(X_WB, b);
  exact::Grid grid;
  grid.include(cornersA);
  grid.include(cornersB);
  return exact::withIntegersFor(grid,
                                [&]<class Int>() { return touch<Int>(cornersA, cornersB, grid); });
}

}  // namespace corridor
