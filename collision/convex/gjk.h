#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "collision/convex/convex_cache.h"
#include "collision/convex/simplex.h"
#include "collision/convex/support.h"
#include "collision/core/rounding.h"

/// The algorithm of Gilbert, Johnson, Keerthi (GJK, 1988) on the cores of two posed convex sets.
/// Its results are *candidates*, not proofs. A caller that needs a proof projects both sets onto
/// the direction found (`PosedSet::highest`), or subtracts a bound of all rounding
/// (convex_distance.cpp, in double-double).
namespace corridor::gjk {

/// The result of a search: bounds of the distance of two cores, metres. The rounding errors of the
/// bounds themselves are not included.
struct Answer {
  bool overlap = false;           ///< the cores overlap by more than rounding can cause
  bool accepted = false;          ///< `accept` returned true and ended the search
  double upper = 0;               ///< upper bound: the distance of two points, one of each core
  double lower = -HUGE_VAL;       ///< lower bound: the widest gap found along a direction
  Vec3 direction = Vec3::Zero();  ///< the direction of that gap, from a to b: unit, rounded
  int rounds = 0;
};

/// A corner of the GJK simplex: a point of core a and a point of core b. A corner also holds the
/// data from which both points can be computed again with more digits.
template <class Real>
struct Corner {
  Vector<Real> a, w;  ///< the point of core a; the vector from it to the point of core b
  std::uint32_t pointA = 0, pointB = 0;  ///< their indices in the `points` of the sets
  Vec3 n = Vec3::Zero();  ///< direction from a to b along which the two points are the extreme ones
};

/// The simplex whose closest points give `Answer::upper`. It has four corners if the cores overlap,
/// none if the search found contact before its first corner, and one to three corners in all other
/// cases.
template <class Real>
struct Simplex {  // NOLINT(bugprone-reserved-identifier): the implicit copy has a variable `__i0`
  Corner<Real> corner[4];
  int count = 0;
};

/// One search for the distance of the cores of two posed sets. Its unit of length is a power of two
/// near `size`, so that squares and cubes neither overflow nor vanish.
template <class Real>
class Search {
 public:
  /// @param size  metres: larger than every coordinate involved.
  /// @param ballsInCores  true: the mapped swept spheres count as parts of the cores. This is
  /// needed for maps that make ellipsoids of the spheres (`Support`).
  Search(const PosedSet& a, const PosedSet& b, double size, bool ballsInCores = false)
      : unit(powerOfTwo(size)),
        a_(a, 1 / unit, ballsInCores),
        b_(b, 1 / unit, ballsInCores),
        noise_(256 * Effort<Real>::roundoff * size / unit),
        curved_(a_.curved() || b_.curved()) {}

  /// Runs the search.
  /// @param from  the simplex that another search ended with, to start from; may be empty.
  /// @param enough  called in every round as enough(upper, lower), both of type `Real`, in metres.
  /// If it returns true, the search ends.
  /// @param accept  called as accept(direction, gap, pointA, pointB) whenever the gap, in metres,
  /// is wider than all earlier gaps. `pointA` and `pointB` are the indices of the points that are
  /// extreme: of a along the direction, of b against it. If it returns true, the search ends.
  template <class Other, class Enough, class Accept>
  Answer run(const Simplex<Other>& from, Enough enough, Accept accept) {
    Answer answer;
    answer.upper = HUGE_VAL;
    for (int i = 0; i < from.count && i < 3; ++i) {
      const Corner<Other>& c = from.corner[i];
      if (c.pointA >= a_.points() || c.pointB >= b_.points()) continue;  // cache of other sets
      const Corner<Real> corner = cornerOf(c.pointA, c.pointB, Vector<Real>(c.n));
      bool known = false;  // at another pose, two corners may be the same
      for (int k = 0; k < known_.count; ++k) known = known || known_.corner[k].w == corner.w;
      if (!known) known_.corner[known_.count++] = corner;
    }
    Nearest<Real> face;
    if (known_.count > 0) {
      take(nearestCorners(), face, answer);
    } else {
      face = nearest<Real>(b_.somewhere() - a_.somewhere());
      face.count = 0;  // an initial direction, not a corner
    }
    Vector<Real> last;
    for (; answer.rounds < Effort<Real>::rounds; ++answer.rounds) {
      const Real norm = length(face.v);
      if (!(norm > Real(0))) return answer;  // contact up to rounding, or NaN
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
        if ((answer.accepted = accept(answer.direction, lower, numberA, numberB))) return answer;
      }
      if (enough(upper_, gap)) return answer;
      bool known = answer.rounds > 0 && corner.w == last;  // also found by the previous round
      for (int i = 0; i < face.count; ++i) known = known || corner.w == face.corner[i];
      last = corner.w;
      if (known && stepped) continue;
      if (known) return answer;  // no progress is possible
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

  const double unit;  ///< the unit of length of all vectors here, metres
  Simplex<Real> simplex;
  Vector<Real> normal;  ///< `Answer::direction` with all its digits
  Real gap{-HUGE_VAL};  ///< `Answer::lower` with all its digits, metres

 private:
  static Vec3 rough(const Vector<Real>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }

  /// Returns the corner that consists of the two points with these indices. If a core has a disc or
  /// a sphere, the point on it that is extreme is taken: along n for core a, along −n for core b.
  Corner<Real> cornerOf(std::uint32_t pointA, std::uint32_t pointB, const Vector<Real>& n) const {
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

  /// Continues with the face found: drops the known corners that do not belong to the face, and
  /// updates the upper bound.
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

  /// Returns the known corners, computed again for direction n. Corners with the same two indices
  /// become one corner.
  Simplex<Real> cornersFor(const Vector<Real>& n) const {
    Simplex<Real> corners;
    for (int i = 0; i < known_.count; ++i) {
      const Corner<Real>& c = known_.corner[i];
      bool seen = false;
      for (int k = 0; k < i; ++k)
        seen = seen || (known_.corner[k].pointA == c.pointA && known_.corner[k].pointB == c.pointB);
      if (!seen) corners.corner[corners.count++] = cornerOf(c.pointA, c.pointB, n);
    }
    return corners;
  }

  /// Takes a Newton step from n towards the direction of the widest gap, for curved surfaces.
  /// Changes n to the new direction. The face is computed again for this direction, and replaced if
  /// the new face is closer. Returns false if no step is defined. The step need not be accurate:
  /// for any direction, the gap is a lower bound of the distance, and the corner found consists of
  /// points of the cores.
  ///
  /// Let w_i(n) be corner i as a function of n, for fixed points of the sets. Then f_i = n·w_i has
  /// the gradient w_i and the Hessian −H, where H is the sum of the Hessians of both sets
  /// (`addCurvature`). To second order in a tangent δ, f_i at the normalised n + δ is f_i + w_i·δ −
  /// δᵀ(H + f I)δ/2. At the widest gap all f_i are equal. With one, two or three corners, this
  /// condition leaves δ two, one or no degrees of freedom. In these degrees of freedom, (H + f I)δ
  /// = w.
  bool newton(Vector<Real>& n, Nearest<Real>& face, Answer& answer) {
    const Simplex<Real> corners = cornersFor(n);
    if (corners.count == 0) return false;
    const Vector<Real>& w = corners.corner[0].w;
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
    if (corners.count == 1) {
      step = bend.inverse() * pull;
    } else {
      Eigen::Matrix2d rows = Eigen::Matrix2d::Zero();
      Eigen::Vector2d wanted = Eigen::Vector2d::Zero();
      for (int i = 0; i + 1 < corners.count; ++i) {
        const Vector<Real> d = corners.corner[i + 1].w - w;
        rows.row(i) = rough(d).transpose() * tangents;
        wanted[i] = -static_cast<double>(dot(n, d));
      }
      if (corners.count == 2) {
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
    known_ = cornersFor(n);
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
  Simplex<Real> known_;  // the corners of the present face
  Real upper_{HUGE_VAL};
};

/// Returns the simplex of a cache. Only the indices and directions of its corners are set.
template <class Real>
Simplex<Real> startOf(const ConvexCache* cache) {
  Simplex<Real> from;
  for (int i = 0; cache && i < cache->count; ++i) {
    const ConvexCache::Corner& c = cache->corner[static_cast<std::size_t>(i)];
    from.corner[from.count++] = {{}, {}, c.pointA, c.pointB, c.n};
  }
  return from;
}
/// Copies the corners of a simplex to the cache, unless `cache` is null.
template <class Real>
void keep(const Simplex<Real>& simplex, ConvexCache* cache) {
  if (!cache) return;
  cache->count = simplex.count;
  for (int i = 0; i < cache->count; ++i) {
    const Corner<Real>& c = simplex.corner[i];
    cache->corner[static_cast<std::size_t>(i)] = {c.pointA, c.pointB, c.n};
  }
}

/// Runs a search for a verdict. The search ends when `accept` returns true, or when the upper bound
/// is at most `near`. It also ends when the two bounds differ by at most 2^-50·size, or by at most
/// `Effort::agreed` times the lower bound.
/// @param size, near  metres.
/// @param cache  if not null, gives the simplex to start from, and receives the simplex that the
/// search ends with.
template <class Real, class Accept>
Answer search(const PosedSet& a, const PosedSet& b, double size, double near, Accept accept,
              bool ballsInCores = false, ConvexCache* cache = nullptr) {
  const auto enough = [&](const Real& upper, const Real& lower) {
    return static_cast<double>(upper) <= near ||
           static_cast<double>(upper - lower) <=
               std::max(0x1p-50 * size, Effort<Real>::agreed * static_cast<double>(lower));
  };
  Search<Real> search(a, b, size, ballsInCores);
  Answer answer = search.run(startOf<Real>(cache), enough, accept);
  keep(search.simplex, cache);
  if (cache) cache->rounds = answer.rounds + 1;
  return answer;
}

}  // namespace corridor::gjk
