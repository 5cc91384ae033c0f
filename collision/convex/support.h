#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"
#include "collision/convex/double_double.h"
#include "collision/convex/point_columns.h"
#include "collision/convex/polytope.h"
#include "collision/convex/simplex.h"
#include "collision/core/rounding.h"

namespace corridor::gjk {

/// Precision and limits of a search in one scalar type.
///
/// `roundoff` is the relative error assumed per operation (for DoubleDouble, more than the error of
/// the format). A search for a verdict (`search` in gjk.h) ends when its two bounds of the distance
/// differ by at most `agreed` times the lower bound. If closer bounds than those of double are
/// needed, a search in double-double follows. `rounds` is the maximum number of rounds. Polytopes
/// need about as many rounds as they have faces that point towards the other polytope. Rims of
/// discs needed at most a hundred in tests.
template <class Real>
struct Effort;
template <>
struct Effort<double> {
  static constexpr double roundoff = 0x1p-53, agreed = 0x1p-36;
  static constexpr int rounds = 64;
};
template <>
struct Effort<DoubleDouble> {
  static constexpr double roundoff = 0x1p-98, agreed = 0;
  static constexpr int rounds = 1000;
};

/// Two unit tangents of a direction: orthogonal to it and to each other.
using Tangents = Eigen::Matrix<double, 3, 2>;

/// The support function of a posed set's core, computed in a scalar type: returns the point that is
/// farthest along a direction.
template <class Real>
class Support {
 public:
  struct Point {
    Vector<Real> x;
    std::uint32_t number;  ///< index of the set's point to which `x` belongs
  };

  /// @param scale  a power of two that all returned points are multiplied by.
  /// @param ballInCore  true: the sphere is a part of the core. This is needed for maps that make
  /// an ellipsoid of the sphere.
  Support(const PosedSet& set, double scale, bool ballInCore = false)
      : set_(set),
        scale_(scale),
        t_(Vec3(set.pose().t * scale)),
        disc_(set.set().disc * scale),
        ball_(ballInCore ? set.set().ball * scale : 0) {
    for (int i = 0; i < 3; ++i) row_[i] = Vector<Real>(Vec3(set.pose().m.row(i)));
    if (set.set().disc > 0) {
      const Vector<Real> d = Vector<Real>(set.set().points[1]) - Vector<Real>(set.set().points[0]);
      axis_ = d * (Real(1) / length(d));
    }
  }

  /// Returns the point of the core farthest along n.
  Point operator()(const Vector<Real>& n) const {
    const Vector<Real> m = row_[0] * n.x + row_[1] * n.y + row_[2] * n.z;
    const std::uint32_t best = farthest(m);
    return {image(best, m), best};
  }
  /// Returns the point of the core that is farthest along n among those that belong to point
  /// `number`: of the disc or the sphere about it, or the point itself.
  Vector<Real> at(std::uint32_t number, const Vector<Real>& n) const {
    last_ = number;
    if (!(disc_ > 0 || ball_ > 0)) return image(number, n);
    return image(number, row_[0] * n.x + row_[1] * n.y + row_[2] * n.z);
  }

  /// Returns how many points the set has.
  std::size_t points() const { return set_.set().points.size(); }
  /// True if the core has a curved surface, on which the point farthest along n moves with n.
  bool curved() const { return disc_ > 0 || ball_ > 0; }
  /// Adds TᵀHT to `sum`, with T the tangents at n and H the Hessian of max n·x over the core, as a
  /// function of n. Returns false if the farthest point jumps at n.
  bool addCurvature(const Vec3& n, const Tangents& tangents, Eigen::Matrix2d& sum) const {
    const Mat3& map = set_.pose().m;
    const Vec3 m = map.transpose() * n;
    if (disc_ > 0) {
      const Vec3 axis = set_.set().axis, across = axis.cross(m);
      const double size = across.norm();
      if (!(size > 0x1p-20)) return false;
      const Eigen::Vector2d u = tangents.transpose() * (map * across) / size;
      sum += disc_ / size * u * u.transpose();
    }
    if (ball_ > 0) {
      const double size = m.norm();
      const Tangents t = map.transpose() * tangents;
      const Eigen::Vector2d u = t.transpose() * m / size;
      sum += ball_ / size * (t.transpose() * t - u * u.transpose());
    }
    return true;
  }

  /// Returns some point of the core: the mean of the set's points.
  Vector<Real> somewhere() const {
    Vec3 mean = Vec3::Zero();
    if (const Polytope* polytope = set_.set().polytope) {
      mean = polytope->center() * scale_;
    } else if (const PointColumns* columns = set_.set().columns) {
      mean = columns->center() * scale_;
    } else {
      for (const Vec3& p : set_.set().points) mean += p;
      mean *= scale_ / static_cast<double>(set_.set().points.size());
    }
    return Vector<Real>(Vec3(set_.pose().m * mean)) + t_;
  }

 private:
  /// Returns the index of the set's point farthest along m. Points that doubles cannot distinguish
  /// from the farthest point are compared in `Real`. (In double, three products and two sums are
  /// off by less than 4u·|m|₁·max|p|.)
  std::uint32_t farthest(const Vector<Real>& m) const {
    const auto points = set_.set().points;
    const Vec3 rough(static_cast<double>(m.x), static_cast<double>(m.y), static_cast<double>(m.z));
    std::uint32_t best = set_.set().farthest(rough, last_);
    last_ = best;
    if (const Polytope* polytope = set_.set().polytope) {
      if constexpr (!std::is_same_v<Real, double>) best = climb(*polytope, best, m);
      return best;
    }
    if constexpr (!std::is_same_v<Real, double>) {
      const double sure =
          rough.dot(points[best]) - 16 * kUnit * rough.lpNorm<1>() * set_.localReach();
      Real most = dot(m, Vector<Real>(points[best]));
      for (std::uint32_t i = 0, first = best; i < points.size(); ++i) {
        if (i == first || rough.dot(points[i]) < sure) continue;
        const Real along = dot(m, Vector<Real>(points[i]));
        if (along > most) most = along, best = i;
      }
    }
    return best;
  }

  /// Goes from vertex to vertex along edges, as long as a neighbour is farther along m. Computed in
  /// `Real`.
  std::uint32_t climb(const Polytope& polytope, std::uint32_t from, const Vector<Real>& m) const {
    std::uint32_t best = from;
    Real most = dot(m, Vector<Real>(polytope.vertices()[best]));
    for (bool higher = true; higher;) {
      higher = false;
      for (const std::uint32_t v : polytope.neighbours(best)) {
        const Real along = dot(m, Vector<Real>(polytope.vertices()[v]));
        if (!(along > most)) continue;
        most = along;
        best = v;
        higher = true;
        break;
      }
    }
    return best;
  }

  Vector<Real> image(std::uint32_t number, const Vector<Real>& m) const {
    Vector<Real> p(Vec3(set_.set().points[number] * scale_));
    if (disc_ > 0) p = p + radial(m) * Real(disc_);
    if (ball_ > 0) {
      const Real size = length(m);
      if (size > Real(0)) p = p + m * (Real(ball_) / size);
    }
    return {dot(row_[0], p) + t_.x, dot(row_[1], p) + t_.y, dot(row_[2], p) + t_.z};
  }

  /// Returns the component of m orthogonal to the axis as a unit vector, or zero if there is none.
  /// The projection is done twice: if the component is small, its value after the first projection
  /// is mostly rounding error. If the second projection removes half of that value, nothing but
  /// rounding error was left, and the result is zero.
  Vector<Real> radial(const Vector<Real>& m) const {
    Vector<Real> e = m;
    for (const double least : {Effort<Real>::roundoff, 0.5}) {
      e = e - axis_ * dot(e, axis_);
      const Real size = length(e);
      if (!(size > Real(least))) return {};
      e = e * (Real(1) / size);
    }
    return e;
  }

  const PosedSet& set_;
  // The most recent vertex; the next hill climbing begins there.
  mutable std::uint32_t last_ = ConvexSet::kCold;
  double scale_;
  Vector<Real> row_[3], t_, axis_;
  double disc_, ball_;
};

}  // namespace corridor::gjk
