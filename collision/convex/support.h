#pragma once

#include <cmath>
#include <cstdint>
#include <type_traits>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"
#include "collision/convex/double_double.h"
#include "collision/convex/simplex.h"
#include "collision/core/rounding.h"

namespace corridor::gjk {

/// How far candidates may be off and how long one may try: unit roundoff of the scalar as used,
/// the share of the distance at which bounds agree (the quick search leaves what is closer to the
/// other), and rounds. Polytopes need as many as they have faces that face each other; rims, a
/// hundred at most were seen.
template <class Real>
struct Effort;
template <>
struct Effort<double> {
  static constexpr double unit = 0x1p-53, agreed = 0x1p-36;
  static constexpr int rounds = 64;
};
template <>
struct Effort<DoubleDouble> {
  static constexpr double unit = 0x1p-98, agreed = 0;
  static constexpr int rounds = 1000;
};

/// Two directions at a right angle to one, and to each other.
using Tangents = Eigen::Matrix<double, 3, 2>;

/// The support points of a posed set's core, in the scalar at hand.
template <class Real>
class Support {
 public:
  struct Point {
    Vector<Real> x;
    std::uint32_t number;
  };

  /// @param scale  a power of two: the image's points come multiplied by it.
  /// @param whole  the ball counts as part of the core: for maps that don't leave it one.
  Support(const PosedSet& set, double scale, bool whole = false)
      : set_(set),
        scale_(scale),
        t_(Vec3(set.pose().t * scale)),
        disc_(set.set().disc * scale),
        ball_(whole ? set.set().ball * scale : 0) {
    for (int i = 0; i < 3; ++i) row_[i] = Vector<Real>(Vec3(set.pose().m.row(i)));
    if (set.set().disc > 0) {
      const Vector<Real> d = Vector<Real>(set.set().points[1]) - Vector<Real>(set.set().points[0]);
      axis_ = d * (Real(1) / length(d));
    }
  }

  /// The point farthest along n.
  Point operator()(const Vector<Real>& n) const {
    const Vector<Real> m = row_[0] * n.x + row_[1] * n.y + row_[2] * n.z;
    const std::uint32_t best = farthest(m);
    return {image(best, m), best};
  }
  /// The one on the given point's disc or ball.
  Vector<Real> at(std::uint32_t number, const Vector<Real>& n) const {
    if (!(disc_ > 0 || ball_ > 0)) return image(number, n);
    return image(number, row_[0] * n.x + row_[1] * n.y + row_[2] * n.z);
  }

  /// Is there a curved surface in the core: does the point farthest along n move with n?
  bool curved() const { return disc_ > 0 || ball_ > 0; }
  /// Adds, for two columns of tangents at n, how it moves: TᵀHT, H the Hessian of max n·x. False
  /// where it jumps.
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

  Vector<Real> somewhere() const {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : set_.set().points) mean += p;
    mean *= scale_ / static_cast<double>(set_.set().points.size());
    return Vector<Real>(Vec3(set_.pose().m * mean)) + t_;
  }

 private:
  /// Those that doubles can't tell from the farthest are compared in `Real`: three products and two
  /// sums are off by less than 4u of |m|₁·max|p|.
  std::uint32_t farthest(const Vector<Real>& m) const {
    const auto points = set_.set().points;
    const Vec3 rough(static_cast<double>(m.x), static_cast<double>(m.y), static_cast<double>(m.z));
    std::uint32_t best = 0;
    double highest = rough.dot(points[0]);
    for (std::uint32_t i = 1; i < points.size(); ++i) {
      const double along = rough.dot(points[i]);
      if (along > highest) highest = along, best = i;
    }
    if constexpr (!std::is_same_v<Real, double>) {
      const double sure = highest - 16 * kUnit * rough.lpNorm<1>() * set_.reach();
      Real most = dot(m, Vector<Real>(points[best]));
      for (std::uint32_t i = 0, first = best; i < points.size(); ++i) {
        if (i == first || rough.dot(points[i]) < sure) continue;
        const Real along = dot(m, Vector<Real>(points[i]));
        if (along > most) most = along, best = i;
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

  /// m's share at a right angle to the axis, as a unit vector; zero where it has none. Taken twice:
  /// a small share is mostly rounding at first, of any direction; where the second time takes away
  /// half of it, it was nothing else.
  Vector<Real> radial(const Vector<Real>& m) const {
    Vector<Real> e = m;
    for (const double least : {Effort<Real>::unit, 0.5}) {
      e = e - axis_ * dot(e, axis_);
      const Real size = length(e);
      if (!(size > Real(least))) return {};
      e = e * (Real(1) / size);
    }
    return e;
  }

  const PosedSet& set_;
  double scale_;
  Vector<Real> row_[3], t_, axis_;
  double disc_, ball_;
};

}  // namespace corridor::gjk
