#include "collision/predicates/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/predicates/exact_number.h"

namespace corridor {

int exactDeterminantSign(const MappedEdge& u, const MappedEdge& v, const MappedEdge& w) {
  const auto corner = [](const MappedPoint& point) {
    return exact::MappedPoints(point.X, std::span(&point.p, 1));
  };
  const std::array<exact::MappedPoints, 6> points = {corner(u.from), corner(u.to),   corner(v.from),
                                                     corner(v.to),   corner(w.from), corner(w.to)};
  exact::Grid grid;
  for (const exact::MappedPoints& each : points) grid.include(each);
  return exact::withIntegersFor(grid, [&]<class Int>() {
    const auto vector = [&](std::size_t i) {
      return exact::mapped<Int>(points[i + 1], 0, grid) - exact::mapped<Int>(points[i], 0, grid);
    };
    return exact::sign(exact::dot(vector(4), exact::cross(vector(0), vector(2))));
  });
}

int orientationSign(const MappedPoint& p, const MappedPoint& q, const MappedPoint& r,
                    const MappedPoint& s) {
  const MappedPoint* const points[4] = {&p, &q, &r, &s};
  Vec3 mapped[4];
  double error = 0;
  for (int i = 0; i < 4; ++i) {
    const auto& [X, v] = *points[i];
    mapped[i] = X * v;
    // A sum of three products and a translation has four roundings on its longest path.
    error =
        std::max(error, 4.1 * kUnit *
                            (X.m.cwiseAbs().rowwise().sum().maxCoeff() * v.cwiseAbs().maxCoeff() +
                             X.t.cwiseAbs().maxCoeff()));
  }
  const Vec3 a = mapped[1] - mapped[0], b = mapped[2] - mapped[0], c = mapped[3] - mapped[0];
  // The bound is that of the filter in triangle_contact.cpp. The entries of the determinant are
  // below D, and each is off by at most e.
  const double d =
      std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  const double e = 2 * roundedUp(error) + kUnit * d, D = d + e;
  if (D > 0x1p-250 && D < 0x1p250) {
    const double det = c.dot(a.cross(b)), bound = roundedUp((18 * e + 40 * kUnit * D) * D * D);
    if (det > bound) return 1;
    if (det < -bound) return -1;
  }
  return exactDeterminantSign({p, q}, {p, r}, {p, s});
}

int lineSide(const Vec2& p, const Vec2& q, const Vec2& r) {
  if (p == q || q == r || r == p) return 0;
  const auto lifted = [](const Vec2& v, double z) { return Vec3(v.x(), v.y(), z); };
  return planeSide(lifted(p, 0), lifted(q, 0), lifted(r, 0), lifted(p, 1));
}

int planeSide(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  // J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
  // Predicates (1997): the rounded determinant is off by at most (7 + 56u)u times the sum of
  // magnitudes, computed as `size` below, if nothing underflows. Each underflow of a difference or
  // a product adds at most 2^-1022 times the product of two of the differences, which are below
  // 2^120: together less than 2^-770.
  const Vec3 a = q - p, b = r - p, c = s - p;
  const double xy[] = {a[0] * b[1], a[1] * b[0]}, yz[] = {a[1] * b[2], a[2] * b[1]},
               zx[] = {a[2] * b[0], a[0] * b[2]};
  const double det = c[2] * (xy[0] - xy[1]) + c[0] * (yz[0] - yz[1]) + c[1] * (zx[0] - zx[1]);
  const double size = std::abs(c[2]) * (std::abs(xy[0]) + std::abs(xy[1])) +
                      std::abs(c[0]) * (std::abs(yz[0]) + std::abs(yz[1])) +
                      std::abs(c[1]) * (std::abs(zx[0]) + std::abs(zx[1]));
  const double error = 8 * kUnit * size + 0x1p-760;
  const double largest = a.cwiseAbs().cwiseMax(b.cwiseAbs()).cwiseMax(c.cwiseAbs()).maxCoeff();
  if (std::abs(det) > error && largest < 0x1p120) return det > 0 ? 1 : -1;
  const Transform identity;
  const MappedPoint from{identity, p};
  return exactDeterminantSign({from, {identity, q}}, {from, {identity, r}}, {from, {identity, s}});
}

}  // namespace corridor
