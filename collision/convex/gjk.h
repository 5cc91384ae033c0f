#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/convex/convex_set.h"
#include "collision/convex/double_double.h"
#include "collision/convex/simplex.h"
#include "collision/core/rounding.h"

/// The algorithm of Gilbert, Johnson, Keerthi (1988) on the cores of two posed convex sets. It
/// finds *candidates*: who needs a proof projects both sets along the direction
/// (`PosedSet::highest`).
namespace corridor::gjk {

/// What it found of the distance between two cores.
struct Answer {
  bool overlap = false;   ///< the cores meet, by more than rounding can feign
  bool accepted = false;  ///< `accept` said so
  double upper = 0;  ///< the distance of two points of the cores: an upper bound but for rounding
  double lower = -HUGE_VAL;       ///< the widest gap found along a direction, likewise from below
  Vec3 direction = Vec3::Zero();  ///< that direction, from a to b: unit, rounded
  int rounds = 0;
};

/// How far candidates may be off and how long one may try: unit roundoff of the scalar as used,
/// the share of the distance at which bounds agree (the quick search leaves what is closer to the
/// other), and rounds. Rims need many rounds, each adding about a third of a digit; polytopes as
/// many as they have faces that face each other.
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

/// The support points of a posed set's core, in the scalar at hand.
template <class Real>
class Support {
 public:
  explicit Support(const PosedSet& set) : set_(set), t_(set.pose().t) {
    for (int i = 0; i < 3; ++i) row_[i] = Vector<Real>(Vec3(set.pose().m.row(i)));
    if (set.set().disc > 0) {
      const Vector<Real> d = Vector<Real>(set.set().points[1]) - Vector<Real>(set.set().points[0]);
      axis_ = d * (Real(1) / length(d));
    }
  }

  /// The point farthest along n.
  Vector<Real> operator()(const Vector<Real>& n) const {
    const Vector<Real> m = row_[0] * n.x + row_[1] * n.y + row_[2] * n.z;
    const auto points = set_.set().points;
    Vector<Real> best(points[0]);
    Real highest = dot(m, best);
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Vector<Real> p(points[i]);
      const Real along = dot(m, p);
      if (along > highest) highest = along, best = p;
    }
    if (set_.set().disc > 0) best = best + radial(m) * Real(set_.set().disc);
    return {dot(row_[0], best) + t_.x, dot(row_[1], best) + t_.y, dot(row_[2], best) + t_.z};
  }

  Vector<Real> somewhere() const {
    Vec3 mean = Vec3::Zero();
    for (const Vec3& p : set_.set().points) mean += p;
    return Vector<Real>(set_.pose() * Vec3(mean / static_cast<double>(set_.set().points.size())));
  }

 private:
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
  Vector<Real> row_[3], t_, axis_;
};

/// @param size  metres: above every coordinate involved. The search ends when upper and lower agree
/// to 2^-50 of it or a share (`Effort`) of the distance.
/// @param accept  asked with the direction and its gap, whenever the gap is wider than any before;
/// true ends the search.
/// @param near  a distance at which the search ends, too: closer does not matter.
template <class Real, class Accept>
Answer search(const PosedSet& a, const PosedSet& b, double size, double near, Accept accept) {
  const Support<Real> supportA(a), supportB(b);
  const Real noise(256 * Effort<Real>::unit * size);
  Answer answer;
  Nearest<Real> face = nearest<Real>(supportB.somewhere() - supportA.somewhere());
  face.count = 0;  // a direction to begin with, no corner
  answer.upper = std::numeric_limits<double>::infinity();
  for (; answer.rounds < Effort<Real>::rounds; ++answer.rounds) {
    const Real norm = length(face.v);
    if (!(norm > Real(0))) return answer;  // touching, as far as can be told; or NaN
    const Vector<Real> n = face.v * (Real(1) / norm);
    const double distance = static_cast<double>(norm);
    const Vector<Real> w = supportB(-n) - supportA(n);
    const double lower = static_cast<double>(dot(n, w));
    if (lower > answer.lower) {
      answer.lower = lower;
      answer.direction = {static_cast<double>(n.x), static_cast<double>(n.y),
                          static_cast<double>(n.z)};
      if ((answer.accepted = accept(answer.direction, lower))) return answer;
    }
    const double enough = std::max(0x1p-50 * size, Effort<Real>::agreed * distance);
    if (answer.upper <= near || answer.upper - answer.lower <= enough) return answer;
    for (int i = 0; i < face.count; ++i)
      if (w == face.corner[i]) return answer;  // nothing new that way
    const Vector<Real>* const c = face.corner;
    switch (face.count) {
      case 0:
        face = nearest(w);
        break;
      case 1:
        face = nearest(c[0], w);
        break;
      case 2:
        face = nearest(c[0], c[1], w);
        break;
      default:
        face = nearest(c[0], c[1], c[2], w, noise);
    }
    if (face.count == 4) {
      answer.overlap = true;
      answer.upper = 0;
      return answer;
    }
    answer.upper = std::min(answer.upper, std::sqrt(static_cast<double>(face.squared)));
  }
  return answer;
}

}  // namespace corridor::gjk
