#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "collision/convex/simplex.h"
#include "collision/convex/support.h"
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
struct Simplex {  // NOLINT(bugprone-reserved-identifier): the compiler's own, of copying the array
  Corner<Real> corner[4];
  int count = 0;
};

/// Two posed sets, and one search for the least distance of their cores. It works in a power of two
/// of metres, about `size`, so that squares and cubes neither overflow nor vanish.
template <class Real>
class Search {
 public:
  /// @param size  metres: above every coordinate involved.
  /// @param whole  balls are in the cores, as the maps' images of them.
  Search(const PosedSet& a, const PosedSet& b, double size, bool whole = false)
      : unit(powerOfTwo(size)),
        a_(a, 1 / unit, whole),
        b_(b, 1 / unit, whole),
        noise_(256 * Effort<Real>::unit * size / unit),
        curved_(a_.curved() || b_.curved()) {}

  /// @param from  corners that another search ended with: to begin with.
  /// @param enough  asked with upper and lower, as Real, whether they agree; true ends the search.
  /// @param accept  asked with the direction and its gap, whenever the gap is wider than any
  /// before; true ends the search.
  template <class Other, class Enough, class Accept>
  Answer run(const Simplex<Other>& from, Enough enough, Accept accept) {
    Answer answer;
    answer.upper = HUGE_VAL;
    for (int i = 0; i < from.count && i < 3; ++i) {
      const Corner<Other>& c = from.corner[i];
      known_.corner[known_.count++] = asked(c.pointA, c.pointB, Vector<Real>(c.n));
    }
    Nearest<Real> face;
    if (known_.count > 0) {
      take(nearestCorners(), face, answer);
    } else {
      face = nearest<Real>(b_.somewhere() - a_.somewhere());
      face.count = 0;  // a direction to begin with, no corner
    }
    Vector<Real> last;
    for (; answer.rounds < Effort<Real>::rounds; ++answer.rounds) {
      const Real norm = length(face.v);
      if (!(norm > Real(0))) return answer;  // touching, as far as can be told; or NaN
      Vector<Real> n = face.v * (Real(1) / norm);
      const bool stepped = curved_ && answer.rounds % 2 == 1 && newton(n, face, answer);
      const auto [pa, numberA] = a_(n);
      const auto [pb, numberB] = b_(-n);
      const Corner<Real> corner{pa, pb - pa, numberA, numberB, rough(n)};
      const Real along = dot(n, corner.w);
      const double lower = unit * static_cast<double>(along);
      if (lower > answer.lower) {
        answer.lower = lower;
        answer.direction = corner.n;
        normal = n;
        gap = along * Real(unit);
        if ((answer.accepted = accept(answer.direction, lower))) return answer;
      }
      if (enough(upper_, gap)) return answer;
      bool known = answer.rounds > 0 && corner.w == last;  // it has been of no use
      for (int i = 0; i < face.count; ++i) known = known || corner.w == face.corner[i];
      last = corner.w;
      if (known && stepped) continue;
      if (known) return answer;  // nothing new that way
      known_.corner[known_.count++] = corner;
      take(nearestCorners(), face, answer);
      if (face.count == 4) {
        simplex = known_;
        answer.overlap = true;
        answer.upper = 0;
        return answer;
      }
    }
    return answer;
  }

  const double unit;  ///< metres: of the vectors here
  Simplex<Real> simplex;
  Vector<Real> normal;  ///< `Answer::direction` and `lower` with all their digits
  Real gap{-HUGE_VAL};

 private:
  static Vec3 rough(const Vector<Real>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }

  Corner<Real> asked(std::uint32_t pointA, std::uint32_t pointB, const Vector<Real>& n) const {
    const Vector<Real> a = a_.at(pointA, n);
    return {a, b_.at(pointB, -n) - a, pointA, pointB, rough(n)};
  }

  Nearest<Real> nearestCorners() const {
    const Corner<Real>* const c = known_.corner;
    switch (known_.count) {
      case 1:
        return nearest(c[0].w);
      case 2:
        return nearest(c[0].w, c[1].w);
      case 3:
        return nearest(c[0].w, c[1].w, c[2].w);
      default:
        return nearest(c[0].w, c[1].w, c[2].w, c[3].w, noise_);
    }
  }

  /// Goes on with the face found, of the corners known: those that it has not are dropped.
  void take(const Nearest<Real>& found, Nearest<Real>& face, Answer& answer) {
    using std::sqrt;
    face = found;
    Simplex<Real> kept;
    for (; kept.count < face.count; ++kept.count)
      for (int i = 0; i < known_.count; ++i)
        if (known_.corner[i].w == face.corner[kept.count])
          kept.corner[kept.count] = known_.corner[i];
    known_ = kept;
    if (face.count == 4 || !(static_cast<double>(face.squared) < HUGE_VAL)) return;
    const Real distance = sqrt(face.squared) * Real(unit);
    if (!(distance < upper_)) return;
    upper_ = distance;
    answer.upper = static_cast<double>(distance);
    simplex = known_;
  }

  /// The corners known, asked again with n; those of the same two points are samples of one.
  Simplex<Real> sampled(const Vector<Real>& n) const {
    Simplex<Real> samples;
    for (int i = 0; i < known_.count; ++i) {
      const Corner<Real>& c = known_.corner[i];
      bool seen = false;
      for (int k = 0; k < i; ++k)
        seen = seen || (known_.corner[k].pointA == c.pointA && known_.corner[k].pointB == c.pointB);
      if (!seen) samples.corner[samples.count++] = asked(c.pointA, c.pointB, n);
    }
    return samples;
  }

  /// A step of Newton's from n to where the gap is widest, where surfaces are curved and corners
  /// are samples of them; the face goes along where that makes it closer. False where there is
  /// none. It only proposes: whatever the direction is, its gap is one and its corner is one.
  ///
  /// Corners of the same two points move together with n: w_i(n), and f_i = n·w_i has the gradient
  /// w_i and the Hessian −H, H that of both sets. To second order in a tangent δ, f_i at n + δ,
  /// normalised, is f_i + w_i·δ − δᵀ(H + f I)δ/2. The widest gap has the same f_i for all, which
  /// leaves δ two, one, or no freedom; along what is left, (H + f I)δ = w.
  bool newton(Vector<Real>& n, Nearest<Real>& face, Answer& answer) {
    const Simplex<Real> samples = sampled(n);
    if (samples.count == 0) return false;
    const Vector<Real>& w = samples.corner[0].w;
    const Vec3 n0 = rough(n);
    Tangents tangents;
    tangents.col(0) = n0.unitOrthogonal();
    tangents.col(1) = n0.cross(tangents.col(0));
    const Real along = dot(n, w);
    const double f = static_cast<double>(along);
    Eigen::Matrix2d bend = f * Eigen::Matrix2d::Identity();
    if (!(f > 0) || !a_.addCurvature(n0, tangents, bend) || !b_.addCurvature(-n0, tangents, bend))
      return false;
    const Eigen::Vector2d pull = tangents.transpose() * rough(w - n * along);
    Eigen::Vector2d step;
    if (samples.count == 1) {
      step = bend.inverse() * pull;
    } else {
      Eigen::Matrix2d rows = Eigen::Matrix2d::Zero();
      Eigen::Vector2d wanted = Eigen::Vector2d::Zero();
      for (int i = 0; i + 1 < samples.count; ++i) {
        const Vector<Real> d = samples.corner[i + 1].w - w;
        rows.row(i) = rough(d).transpose() * tangents;
        wanted[i] = -static_cast<double>(dot(n, d));
      }
      if (samples.count == 2) {
        const Eigen::Vector2d left(-rows(0, 1), rows(0, 0));
        rows.row(1) = left.transpose() * bend;
        wanted[1] = left.dot(pull);
      }
      step = rows.inverse() * wanted;
    }
    if (!(step.squaredNorm() < 1)) return false;
    n = n + Vector<Real>(Vec3(tangents * step));
    n = n * (Real(1) / length(n));

    const Simplex<Real> before = known_;
    known_ = sampled(n);
    const Nearest<Real> found = nearestCorners();
    if (found.squared < face.squared)
      take(found, face, answer);
    else
      known_ = before;
    return true;
  }

  Support<Real> a_, b_;
  Real noise_;
  bool curved_;
  Simplex<Real> known_;  // the face's corners
  Real upper_{HUGE_VAL};
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
