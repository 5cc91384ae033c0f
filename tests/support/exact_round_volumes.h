#pragma once

#include <array>

#include "collision/volumes/ellipsoid.h"
#include "collision/volumes/shell.h"
#include "tests/support/exact_volume.h"

namespace corridor::exact {

/// Tests two conditions for a sphere: that its centre is in the core ellipsoid, and that its radius
/// is at most `size`. Let c be the centre of the ellipsoid, u_k its axes and half_k its half
/// lengths. Let v_k = u_i × u_j be the cross product of the other two axes, and det = u_0·v_0. By
/// Cramer's rule the sphere's centre p has the coordinates x_k = (p − c)·v_k/det along the axes.
/// The condition Σ (x_k/half_k)² ≤ 1 is multiplied by (half_0 half_1 half_2 det)², because
/// divisions would make the numbers long. Therefore `rows_` has the vectors v_k·half_i·half_j.
template <>
class ExactVolume<Ellipsoid> {
 public:
  explicit ExactVolume(const Ellipsoid& e) : center_(row(e.core.center)), size_(e.size) {
    std::array<Row, 3> u;
    for (int k = 0; k < 3; ++k) u[k] = row(e.core.axes.col(k));
    const Row half = row(e.core.half);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      rows_[k] = cross(u[i], u[j]);
      for (Rational& x : rows_[k]) x *= half[i] * half[j];
    }
    const Rational all = half[0] * half[1] * half[2] * dot(u[0], cross(u[1], u[2]));
    limit_ = all * all;
  }
  bool contains(const Row& p, const Rational& radius) const {
    if (limit_ == 0 || radius > size_) return false;
    const Row d = minus(p, center_);
    Rational square = 0;
    for (const Row& r : rows_) {
      const Rational x = dot(d, r);
      square += x * x;
    }
    return square <= limit_;
  }

 private:
  Row center_;
  Rational size_, limit_;
  std::array<Row, 3> rows_;
};

/// Tests the centre and the radius of a sphere separately, as for ellipsoids. A triangle is inside
/// if two conditions hold. Its corners are in the outer sphere and in the cone, which are convex.
/// And a direction n proves that the triangle is outside of the inner sphere. The only direction
/// that is tried is the one that the fit of the shell uses, so the proof may fail for a triangle
/// that is inside.
template <>
class ExactVolume<Shell> {
 public:
  explicit ExactVolume(const Shell& s)
      : shell_(s),
        center_(row(s.center)),
        axis_(row(s.axis)),
        axisSquare_(dot(axis_, axis_)),
        inner_(s.inner),
        outer_(s.outer),
        slope_(s.hasCone() ? s.slope : 0) {}

  /// Returns whether the sphere is proved to be in the part of the shell beyond the plane that
  /// touches the inner sphere on the axis.
  bool contains(const Row& p, const Rational& radius) const {
    const Row d = minus(p, center_);
    if (radius > Rational(shell_.size) || !inConvexParts(d)) return false;
    return inner_ == 0 || beyond(d, axis_, axisSquare_);
  }
  bool containsTriangle(const Triangle& triangle) const {
    std::array<Row, 3> d;
    for (std::size_t k = 0; k < 3; ++k) {
      d[k] = minus(row(triangle[k]), center_);
      if (!inConvexParts(d[k])) return false;
    }
    if (inner_ == 0) return true;
    const double unit = powerOfTwo(shell_.outer);
    const auto local = [&](const Vec3& p) -> Vec3 { return (p - shell_.center) / unit; };
    const Vec3 n = towardsTriangle(local(triangle[0]), local(triangle[1]), local(triangle[2]));
    if (!n.allFinite()) return false;
    const Row direction = row(n);
    const Rational square = dot(direction, direction);
    return beyond(d[0], direction, square) && beyond(d[1], direction, square) &&
           beyond(d[2], direction, square);
  }

 private:
  bool inConvexParts(const Row& d) const {
    if (dot(d, d) > outer_ * outer_) return false;
    if (!shell_.hasCone()) return true;
    const Rational along = dot(d, axis_);
    const Row across = cross(d, axis_);
    return along >= 0 && dot(across, across) <= slope_ * slope_ * along * along;
  }
  /// Returns whether d·n ≥ inner·|n|.
  bool beyond(const Row& d, const Row& n, const Rational& square) const {
    const Rational along = dot(d, n);
    return along >= 0 && along * along >= inner_ * inner_ * square;
  }

  Shell shell_;
  Row center_, axis_;
  Rational axisSquare_, inner_, outer_, slope_;
};

}  // namespace corridor::exact
