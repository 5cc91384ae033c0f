#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

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

/// A point of core a, w from it to one of core b, and how to find both again with more digits: the
/// numbers of the sets' points, and the direction, from a to b, that rims were asked with.
template <class Real>
struct Corner {
  Vector<Real> a, w;
  std::uint32_t pointA = 0, pointB = 0;
  Vec3 n = Vec3::Zero();
};

/// The corners whose hull has `upper`: up to three, four where the cores overlap; none where the
/// search met before it began.
template <class Real>
struct Simplex {
  Corner<Real> corner[4];
  int count = 0;
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

/// Two posed sets, and the search for the least distance of their cores. It works in a power of two
/// of metres, about `size`, so that squares and cubes neither overflow nor vanish.
template <class Real>
class Search {
 public:
  /// @param size  metres: above every coordinate involved.
  /// @param whole  balls are in the cores, as the maps' images of them.
  Search(const PosedSet& a, const PosedSet& b, double size, bool whole = false)
      : unit(std::ldexp(1.0, std::clamp(std::ilogb(size), -1000, 1000))),
        a_(a, 1 / unit, whole),
        b_(b, 1 / unit, whole),
        noise_(256 * Effort<Real>::unit * size / unit) {}

  /// @param from  corners that another search ended with: to begin with.
  /// @param enough  asked with upper and lower whether they agree; true ends the search.
  /// @param accept  asked with the direction and its gap, whenever the gap is wider than any
  /// before; true ends the search.
  template <class Other, class Enough, class Accept>
  Answer run(const Simplex<Other>& from, Enough enough, Accept accept) {
    Answer answer;
    answer.upper = std::numeric_limits<double>::infinity();
    Nearest<Real> face = begin(from);
    if (face.count == 0) {
      face = nearest<Real>(b_.somewhere() - a_.somewhere());
      face.count = 0;  // a direction to begin with, no corner
    } else {
      answer.upper = unit * std::sqrt(static_cast<double>(face.squared));
    }
    for (; answer.rounds < Effort<Real>::rounds; ++answer.rounds) {
      const Real norm = length(face.v);
      if (!(norm > Real(0))) return answer;  // touching, as far as can be told; or NaN
      const Vector<Real> n = face.v * (Real(1) / norm);
      const auto [pa, numberA] = a_(n);
      const auto [pb, numberB] = b_(-n);
      const Vector<Real> w = pb - pa;
      const Real gapAlong = dot(n, w);
      const double lower = unit * static_cast<double>(gapAlong);
      const Vec3 direction(static_cast<double>(n.x), static_cast<double>(n.y),
                           static_cast<double>(n.z));
      if (lower > answer.lower) {
        answer.lower = lower;
        answer.direction = direction;
        normal = n;
        gap = gapAlong;
        if ((answer.accepted = accept(direction, lower))) return answer;
      }
      if (enough(answer.upper, answer.lower)) return answer;
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
          face = nearest(c[0], c[1], c[2], w, noise_);
      }
      known_.corner[known_.count++] = {pa, w, numberA, numberB, direction};
      keep(face);
      if (face.count == 4) {
        simplex = known_;
        answer.overlap = true;
        answer.upper = 0;
        return answer;
      }
      const double distance = unit * std::sqrt(static_cast<double>(face.squared));
      if (distance < answer.upper) {
        answer.upper = distance;
        simplex = known_;
      }
    }
    return answer;
  }

  const double unit;  ///< metres: of all vectors here
  Simplex<Real> simplex;
  Vector<Real> normal;  ///< `Answer::direction` and `lower` with all their digits
  Real gap{};

 private:
  template <class Other>
  Nearest<Real> begin(const Simplex<Other>& from) {
    for (int i = 0; i < from.count && i < 3; ++i) {
      const Corner<Other>& c = from.corner[i];
      const Vector<Real> n(c.n), pa = a_.at(c.pointA, n), pb = b_.at(c.pointB, -n);
      known_.corner[known_.count++] = {pa, pb - pa, c.pointA, c.pointB, c.n};
    }
    const Corner<Real>* const c = known_.corner;
    Nearest<Real> face = known_.count == 0   ? Nearest<Real>()
                         : known_.count == 1 ? nearest(c[0].w)
                         : known_.count == 2 ? nearest(c[0].w, c[1].w)
                                             : nearest(c[0].w, c[1].w, c[2].w);
    keep(face);
    simplex = known_;
    return face;
  }

  /// Of the corners known, the face's, in its order.
  void keep(const Nearest<Real>& face) {
    Simplex<Real> kept;
    for (; kept.count < face.count; ++kept.count)
      for (int i = 0; i < known_.count; ++i)
        if (known_.corner[i].w == face.corner[kept.count])
          kept.corner[kept.count] = known_.corner[i];
    known_ = kept;
  }

  Support<Real> a_, b_;
  Real noise_;
  Simplex<Real> known_;
};

/// A search for verdicts: it ends, too, when upper and lower agree to 2^-50 of the size or a share
/// (`Effort`) of the distance.
/// @param near  a distance at which the search ends: closer does not matter.
template <class Real, class Accept>
Answer search(const PosedSet& a, const PosedSet& b, double size, double near, Accept accept,
              bool whole = false) {
  const auto enough = [&](double upper, double lower) {
    return upper <= near || upper - lower <= std::max(0x1p-50 * size, Effort<Real>::agreed * lower);
  };
  return Search<Real>(a, b, size, whole).run(Simplex<Real>(), enough, accept);
}

}  // namespace corridor::gjk
