#pragma once

#include <cmath>

#include "collision/core/transform.h"

/// The distance sub-algorithm of GJK: the point of a simplex closest to the origin. The direction
/// of that point is accurate even for a tiny distance: it is the normal of the face that contains
/// the point, or the vector from the origin, made orthogonal to the edge. The direction is never
/// computed only as the difference of two close points.
namespace corridor::gjk {

/// A vector of three numbers of a scalar type that Eigen does not support.
template <class Real>
struct Vector {
  Real x{}, y{}, z{};

  Vector() = default;
  Vector(const Real& x0, const Real& y0, const Real& z0) : x(x0), y(y0), z(z0) {}
  explicit Vector(const Vec3& v) : x(v[0]), y(v[1]), z(v[2]) {}

  friend Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  Vector operator-() const { return {-x, -y, -z}; }
  friend Vector operator*(const Vector& a, const Real& s) { return {a.x * s, a.y * s, a.z * s}; }
  friend Real dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  friend bool operator==(const Vector& a, const Vector& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

template <class Real>
Real length(const Vector<Real>& v) {
  using std::sqrt;
  return sqrt(dot(v, v));
}

/// The smallest face of a simplex that contains the simplex's point closest to the origin.
template <class Real>
struct Nearest {
  Vector<Real> v;          ///< the closest point; its direction is more accurate than its length
  Real squared = Real(0);  ///< its squared distance from the origin
  int count = 0;           ///< number of corners; 4: the origin is inside, by more than rounding
  Vector<Real> corner[4];
};

template <class Real>
Nearest<Real> nearest(const Vector<Real>& a) {
  return {a, dot(a, a), 1, {a}};
}

template <class Real>
Nearest<Real> nearest(const Vector<Real>& a, const Vector<Real>& b) {
  const Vector<Real> d = b - a;
  const Real square = dot(d, d), along = -dot(a, d);
  if (!(along > Real(0))) return nearest(a);
  if (!(along < square)) return nearest(b);
  Vector<Real> v = a + d * (along / square);
  v = v - d * (dot(v, d) / square);  // orthogonal to d again, despite cancellation above
  return {v, dot(v, v), 2, {a, b}};
}

template <class Real>
Nearest<Real> nearest(const Vector<Real>& a, const Vector<Real>& b, const Vector<Real>& c) {
  const Vector<Real> ab = b - a, bc = c - b, ca = a - c, n = cross(ab, bc);
  const Real square = dot(n, n), zero(0);
  // For each edge: whether the projection of the origin onto the triangle's plane is on the outer
  // side of the edge. This is true for all edges if the triangle is degenerate.
  const Real areaC = dot(n, cross(a, ab)), areaA = dot(n, cross(b, bc)),
             areaB = dot(n, cross(c, ca));
  const bool outAB = !(areaC > zero), outBC = !(areaA > zero), outCA = !(areaB > zero);
  if (square > zero && !outAB && !outBC && !outCA) {
    // The distance is that of `foot`, a convex combination of the corners: a point of the triangle,
    // whatever the rounding of the weights. The direction is the normal of the triangle.
    const Vector<Real> foot =
        (a * areaA + b * areaB + c * areaC) * (Real(1) / (areaA + areaB + areaC));
    return {n * (dot(n, a) / square), dot(foot, foot), 3, {a, b, c}};
  }
  Nearest<Real> best;
  const auto offer = [&](bool out, const Vector<Real>& p, const Vector<Real>& q) {
    if (!out) return;
    const Nearest<Real> edge = nearest(p, q);
    if (best.count == 0 || edge.squared < best.squared) best = edge;
  };
  offer(outAB, a, b);
  offer(outBC, b, c);
  offer(outCA, c, a);
  return best.count > 0 ? best : nearest(a, b);
}

/// @param noise  rounding error of the corners' coordinates; heights of this order count as 0.
template <class Real>
Nearest<Real> nearest(const Vector<Real>& a, const Vector<Real>& b, const Vector<Real>& c,
                      const Vector<Real>& d, const Real& noise) {
  const Vector<Real>* const corners[4] = {&a, &b, &c, &d};
  Real largest(0);
  for (const Vector<Real>* p : corners) {
    const Real s = dot(*p, *p);
    if (s > largest) largest = s;
  }
  const Real unsure = noise * largest;  // error of a determinant
  Nearest<Real> best;
  for (int k = 0; k < 4; ++k) {
    const Vector<Real>&p = *corners[(k + 1) % 4], &q = *corners[(k + 2) % 4],
          &r = *corners[(k + 3) % 4];
    const Vector<Real> n = cross(q - p, r - p);
    Real origin = -dot(n, p), apex = dot(n, *corners[k] - p);
    if (apex < Real(0)) {
      origin = -origin;
      apex = -apex;
    }
    if (origin > unsure && apex > unsure) continue;
    const Nearest<Real> face = nearest(p, q, r);
    if (best.count == 0 || face.squared < best.squared) best = face;
  }
  if (best.count > 0) return best;
  return {{}, Real(0), 4, {a, b, c, d}};
}

}  // namespace corridor::gjk
