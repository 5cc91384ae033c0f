#include "collision/predicates/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/predicates/exact_number.h"

namespace corridor {
namespace {

using Corners = std::array<exact::MappedPoints, 4>;

template <class Int>
int exactSign(const Corners& points, const exact::Grid& grid) {
  const auto at = [&](int i) { return exact::mapped<Int>(points[i], 0, grid); };
  const exact::Vector<Int> p = at(0);
  return exact::sign(exact::dot(at(3) - p, exact::cross(at(1) - p, at(2) - p)));
}

}  // namespace

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
  // The bound of the filter in triangle_contact.cpp: entries below D, each off by at most e.
  const double d =
      std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  const double e = 2 * roundedUp(error) + kUnit * d, D = d + e;
  if (D > 0x1p-250 && D < 0x1p250) {
    const double det = c.dot(a.cross(b)), bound = roundedUp((18 * e + 40 * kUnit * D) * D * D);
    if (det > bound) return 1;
    if (det < -bound) return -1;
  }
  const auto corner = [](const MappedPoint& point) {
    return exact::MappedPoints(point.X, std::span(&point.p, 1));
  };
  const Corners corners = {corner(p), corner(q), corner(r), corner(s)};
  exact::Grid grid;
  for (const exact::MappedPoints& each : corners) grid.include(each);
  return exact::withIntegersFor(grid, [&]<class Int>() { return exactSign<Int>(corners, grid); });
}

}  // namespace corridor
