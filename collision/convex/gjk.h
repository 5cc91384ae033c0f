#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <Eigen/Geometry>
#include <Eigen/LU>

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

  /// Is there a curved surface in the core: does the point farthest along n move with n?
  bool curved() const { return disc_ > 0 || ball_ > 0; }
  /// Adds, for two columns of tangents at n, how it moves: TᵀHT, H the Hessian of max n·x. False
  /// where it jumps.
  bool addCurvature(const Vec3& n, const Eigen::Matrix<double, 3, 2>& tangents,
                    Eigen::Matrix2d& sum) const {
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
      const Eigen::Matrix<double, 3, 2> t = map.transpose() * tangents;
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
        noise_(256 * Effort<Real>::unit * size / unit),
        curved_(a_.curved() || b_.curved()) {}

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
      lowerUpper(answer, face);
    }
    for (; answer.rounds < Effort<Real>::rounds; ++answer.rounds) {
      const Real norm = length(face.v);
      if (!(norm > Real(0))) return answer;  // touching, as far as can be told; or NaN
      Vector<Real> n = face.v * (Real(1) / norm);
      const bool stepped = curved_ && answer.rounds % 2 == 1 && newton(n);
      if (stepped && resample(n, face)) lowerUpper(answer, face);
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
        gap = gapAlong * Real(unit);
        if ((answer.accepted = accept(direction, lower))) return answer;
      }
      if (enough(upper_, gap)) return answer;
      bool known = false;
      for (int i = 0; i < face.count; ++i) known = known || w == face.corner[i];
      if (known && stepped) continue;
      if (known) return answer;  // nothing new that way
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
      lowerUpper(answer, face);
    }
    return answer;
  }

  const double unit;  ///< metres: of the vectors here
  Simplex<Real> simplex;
  Vector<Real> normal;  ///< `Answer::direction` and `lower` with all their digits
  Real gap{-HUGE_VAL};

 private:
  template <class Other>
  Nearest<Real> begin(const Simplex<Other>& from) {
    for (int i = 0; i < from.count && i < 3; ++i) {
      const Corner<Other>& c = from.corner[i];
      const Vector<Real> n(c.n), pa = a_.at(c.pointA, n), pb = b_.at(c.pointB, -n);
      known_.corner[known_.count++] = {pa, pb - pa, c.pointA, c.pointB, c.n};
    }
    const Nearest<Real> face = nearestOf(known_);
    keep(face);
    return face;
  }

  static Nearest<Real> nearestOf(const Simplex<Real>& s) {
    const Corner<Real>* const c = s.corner;
    return s.count == 0   ? Nearest<Real>()
           : s.count == 1 ? nearest(c[0].w)
           : s.count == 2 ? nearest(c[0].w, c[1].w)
                          : nearest(c[0].w, c[1].w, c[2].w);
  }

  void lowerUpper(Answer& answer, const Nearest<Real>& face) {
    using std::sqrt;
    if (!(static_cast<double>(face.squared) < HUGE_VAL)) return;
    const Real distance = sqrt(face.squared) * Real(unit);
    if (!(distance < upper_)) return;
    upper_ = distance;
    answer.upper = static_cast<double>(distance);
    simplex = known_;
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
  /// A step of Newton's from n to where the gap is widest, where surfaces are curved and corners of
  /// the simplex are samples of them; false where there is none. (It only proposes a direction.)
  ///
  /// Corners of the same two points move together with n: w_i(n), and f_i = n·w_i has the gradient
  /// w_i and the Hessian −H, H that of both sets. To second order in a tangent δ, f_i at n + δ,
  /// normalised, is f_i + w_i·δ − δᵀ(H + f I)δ/2. The widest gap has the same f_i for all, which
  /// leaves δ two, one, or no freedom; along what is left, (H + f I)δ = w.
  bool newton(Vector<Real>& n) const {
    Vector<Real> w[3];
    int count = 0;
    for (int i = 0; i < known_.count; ++i) {
      const Corner<Real>& c = known_.corner[i];
      bool seen = false;
      for (int k = 0; k < i; ++k)
        seen = seen || (known_.corner[k].pointA == c.pointA && known_.corner[k].pointB == c.pointB);
      if (!seen) w[count++] = b_.at(c.pointB, -n) - a_.at(c.pointA, n);
    }
    if (count == 0) return false;
    const auto rough = [](const Vector<Real>& v) {
      return Vec3(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
    };
    const Vec3 n0 = rough(n);
    Eigen::Matrix<double, 3, 2> tangents;
    tangents.col(0) = n0.unitOrthogonal();
    tangents.col(1) = n0.cross(tangents.col(0));
    const Real gapAlong = dot(n, w[0]);
    const double f = static_cast<double>(gapAlong);
    Eigen::Matrix2d bend = f * Eigen::Matrix2d::Identity();
    if (!(f > 0) || !a_.addCurvature(n0, tangents, bend) || !b_.addCurvature(-n0, tangents, bend))
      return false;
    const Eigen::Vector2d pull = tangents.transpose() * rough(w[0] - n * gapAlong);
    Eigen::Vector2d step;
    if (count == 1) {
      step = bend.inverse() * pull;
    } else {
      Eigen::Matrix2d rows;
      Eigen::Vector2d wanted;
      for (int i = 0; i + 1 < count; ++i) {
        const Vector<Real> d = w[i + 1] - w[0];
        rows.row(i) = (tangents.transpose() * rough(d)).transpose();
        wanted[i] = -static_cast<double>(dot(n, d));
      }
      if (count == 2) {
        const Eigen::Vector2d free(-rows(0, 1), rows(0, 0));
        rows.row(1) = free.transpose() * bend;
        wanted[1] = free.dot(pull);
      }
      step = rows.inverse() * wanted;
    }
    if (!(step.squaredNorm() < 1)) return false;
    n = n + Vector<Real>(Vec3(tangents * step));
    n = n * (Real(1) / length(n));
    return true;
  }

  /// What corners there are, asked again with n: a new face where that is closer.
  bool resample(const Vector<Real>& n, Nearest<Real>& face) {
    const Simplex<Real> before = known_;
    Simplex<Real> asked;
    for (int i = 0; i < known_.count; ++i) {
      Corner<Real> c = known_.corner[i];
      bool seen = false;
      for (int k = 0; k < asked.count; ++k)
        seen = seen || (asked.corner[k].pointA == c.pointA && asked.corner[k].pointB == c.pointB);
      if (seen) continue;
      c.n = Vec3(static_cast<double>(n.x), static_cast<double>(n.y), static_cast<double>(n.z));
      c.a = a_.at(c.pointA, n);
      c.w = b_.at(c.pointB, -n) - c.a;
      asked.corner[asked.count++] = c;
    }
    known_ = asked;
    const Nearest<Real> found = nearestOf(known_);
    if (!(found.squared < face.squared)) {
      known_ = before;
      return false;
    }
    face = found;
    keep(face);
    return true;
  }

  Real noise_;
  Real upper_{HUGE_VAL};
  bool curved_;
  Simplex<Real> known_;
};

/// A search for verdicts: it ends, too, when upper and lower agree to 2^-50 of the size or a share
/// (`Effort`) of the distance.
/// @param near  a distance at which the search ends: closer does not matter.
template <class Real, class Accept>
Answer search(const PosedSet& a, const PosedSet& b, double size, double near, Accept accept,
              bool whole = false) {
  const auto enough = [&](const Real& upper, const Real& lower) {
    return static_cast<double>(upper) <= near ||
           static_cast<double>(upper - lower) <=
               std::max(0x1p-50 * size, Effort<Real>::agreed * static_cast<double>(lower));
  };
  return Search<Real>(a, b, size, whole).run(Simplex<Real>(), enough, accept);
}

}  // namespace corridor::gjk
