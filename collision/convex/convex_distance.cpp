#include "collision/convex/convex_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/convex/convex_contact.h"
#include "collision/convex/gjk.h"
#include "collision/core/rounding.h"

/// The bounds. Let g_A and g_B be the closest points of the cores, d = g_B − g_A, n = d/|d|, M_A
/// and M_B the matrices of the maps, and r_A and r_B the radii of the swept spheres.
/// * Upper bound: g_A + r_A·M_A m_A/|m_A| and g_B − r_B·M_B m_B/|m_B|, with m_A = M_Aᵀn and m_B =
///   M_Bᵀn, are points of the sets for any n and any maps. The distance of these two points is the
///   upper bound.
/// * Lower bound: the widest gap of the cores that GJK has found, minus the sum r_A|m_A| + r_B|m_B|
///   for the direction of that gap.
///
/// Under rotations both bounds agree when the search ends. Under a map of defect η
/// (`orthonormalityDefect`) they differ by up to some 3η times the radius of a sphere, because the
/// closest points of the ellipsoids are not on the line through the closest points of the cores. If
/// this difference exceeds the requested error, the search is repeated with the spheres as parts of
/// the cores.
///
/// Rounding. Let u be 2^-53 in double and 2^-98 in double-double; errors are relative to `size`.
/// `PosedSet` bounds the error of its projections. A corner of a simplex is a mapped point with its
/// disc, and the same derivation bounds its error (three products and sums per coordinate, 6u for
/// the disc). A convex combination of three corners has 8 roundings. The errors of both witness
/// points together are below twice the errors of the sets.
namespace corridor {
namespace {

using gjk::Vector;

template <class Real>
Vec3 rounded(const Vector<Real>& v, double unit) {
  return unit * Vec3(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}

template <class Real>
struct Points {
  Vector<Real> a, w;  ///< a point of core a, and the vector from it to a point of core b
};

/// Returns the closest points of the cores that a simplex gives.
template <class Real>
Points<Real> closest(const gjk::Simplex<Real>& simplex) {
  const gjk::Corner<Real>* const c = simplex.corner;
  const Real zero(0), one(1);
  Real weight[4] = {one, zero, zero, zero};
  if (simplex.count == 2) {
    const Vector<Real> d = c[1].w - c[0].w;
    weight[1] = -dot(c[0].w, d) / dot(d, d);
    weight[0] = one - weight[1];
  } else if (simplex.count == 3) {
    const Vector<Real> ab = c[1].w - c[0].w, bc = c[2].w - c[1].w, ca = c[0].w - c[2].w;
    const Vector<Real> n = cross(ab, bc);
    weight[0] = dot(n, cross(c[1].w, bc));
    weight[1] = dot(n, cross(c[2].w, ca));
    weight[2] = dot(n, cross(c[0].w, ab));
    const Real sum = weight[0] + weight[1] + weight[2];
    for (int i = 0; i < 3; ++i) weight[i] = weight[i] / sum;
  } else if (simplex.count == 4) {  // the origin is inside the tetrahedron of the corners
    Real sum(0);
    for (int i = 0; i < 4; ++i) {
      const Vector<Real>&p = c[(i + 1) % 4].w, &q = c[(i + 2) % 4].w, &r = c[(i + 3) % 4].w;
      const Vector<Real> n = cross(q - p, r - p);
      weight[i] = dot(n, p) / dot(n, p - c[i].w);
      sum = sum + weight[i];
    }
    for (int i = 0; i < 4; ++i) weight[i] = weight[i] / sum;
  }
  Points<Real> points;
  for (int i = 0; i < std::max(1, simplex.count); ++i) {
    points.a = points.a + c[i].a * weight[i];
    points.w = points.w + c[i].w * weight[i];
  }
  return points;
}

/// Returns Mᵀn.
template <class Real>
Vector<Real> local(const PosedSet& set, const Vector<Real>& n) {
  const Mat3& m = set.pose().m;
  return Vector<Real>(Vec3(m.row(0))) * n.x + Vector<Real>(Vec3(m.row(1))) * n.y +
         Vector<Real>(Vec3(m.row(2))) * n.z;
}

/// Returns the point of a mapped unit sphere about 0 that is farthest along n: M m/|m| with m =
/// Mᵀn, or 0 if the map flattens the sphere along n.
template <class Real>
Vector<Real> ballPoint(const PosedSet& set, const Vector<Real>& n) {
  const Vector<Real> m = local(set, n);
  const Real size = gjk::length(m);
  if (!(size > Real(0))) return {};
  const Vector<Real> unit = m * (Real(1) / size);
  const Mat3& rows = set.pose().m;
  return {dot(Vector<Real>(Vec3(rows.row(0))), unit), dot(Vector<Real>(Vec3(rows.row(1))), unit),
          dot(Vector<Real>(Vec3(rows.row(2))), unit)};
}

/// Returns r|Mᵀn|, the reach of the mapped sphere of a set along n, where r is the radius of the
/// sphere.
template <class Real>
Real ballReach(const PosedSet& set, const Vector<Real>& n) {
  return gjk::length(local(set, n)) * Real(set.set().ball);
}

/// How a search takes the spheres of two sets: they are added to its result, or they are parts of
/// the cores that it searches.
enum class Spheres { aroundCores, inCores };

class Pair {
 public:
  Pair(const PosedSet& a, const PosedSet& b)
      : a_(a),
        b_(b),
        size_(a.reach() + a.pose().t.norm() + b.reach() + b.pose().t.norm()),
        radii_(a.set().ball + b.set().ball),
        // The first two terms are the errors of the projections. The third covers the rounding of
        // their sum and of subtracting this bound. It also covers the error that arises because n
        // is not exactly a unit vector: a gap, which is below `size`, is scaled by |n| ≤ 1 + 5u.
        error_(roundedUp(a.error() + b.error() + 7 * kUnit * size_)) {}

  double size() const { return size_; }
  double radii() const { return radii_; }
  /// Returns the distance of the cores up to which the sets count as touching, if the maps take
  /// spheres to spheres (`convexSetsTouch`).
  double touchDistance() const { return radii_ + 0x1p-49 * size_; }
  /// Returns the band: if the sets are farther apart than this, `convexSetsTouch` returns false.
  double band() const { return 0x1p-44 * size_; }

  /// Returns a proved lower bound of the gap along n, with all rounding covered; metres.
  /// @param pointA, pointB  indices of points that are likely extreme along n, as starts of the
  /// search for the extreme points.
  double gap(const Vec3& n, std::uint32_t pointA, std::uint32_t pointB) const {
    return -b_.highest(-n, pointB) - a_.highest(n, pointA) - error_;
  }
  /// Returns the gap along the direction that a search has found. The search for extreme points
  /// starts at a corner of the simplex of that search.
  double gap(const gjk::Answer& found, const gjk::Search<double>& search) const {
    const bool none = search.simplex.count == 0;
    const gjk::Corner<double>& corner = search.simplex.corner[0];
    return gap(found.direction, none ? ConvexSet::kCold : corner.pointA,
               none ? ConvexSet::kCold : corner.pointB);
  }
  /// Returns the error bound of a distance computed in double.
  double error() const { return 2 * error_; }

  /// Returns whether the closest points of the search's simplex confirm the contact that the search
  /// found. If the cores overlap so little that the four corners are nearly in one plane, the
  /// contact is not confirmed: the weights of the corners are then mostly rounding error.
  template <class Real>
  bool met(const gjk::Search<Real>& search) const {
    return search.unit * static_cast<double>(gjk::length(closest(search.simplex).w)) <=
           touchDistance();
  }

  /// Returns the result for sets that touch: a common point, up to rounding.
  /// @param spheres where they were in the search.
  template <class Real>
  ConvexDistance contact(const gjk::Search<Real>& search, Spheres spheres) const {
    ConvexDistance result;
    if (search.simplex.count == 0) {
      result.p_WA = result.p_WB =
          rounded(gjk::Support<double>(a_, 1 / search.unit).somewhere(), search.unit);
      return result;
    }
    const Points<Real> points = closest(search.simplex);
    const double share = spheres == Spheres::inCores || radii_ == 0 ? 0.5 : a_.set().ball / radii_;
    result.p_WA = result.p_WB = rounded(points.a + points.w * Real(share), search.unit);
    return result;
  }

  /// Returns the result for sets that are apart. @param spheres as for `contact`.
  template <class Real>
  ConvexDistance apart(const gjk::Search<Real>& search, Spheres spheres) const {
    Points<Real> p = closest(search.simplex);
    Real lower = search.gap * Real(1 / search.unit);
    if (spheres == Spheres::aroundCores && radii_ > 0) {
      const Vector<Real> n = p.w * (Real(1) / gjk::length(p.w));
      const Real unitsPerMetre(1 / search.unit);
      if (a_.set().ball > 0) {
        const Vector<Real> reach = ballPoint(a_, n) * (Real(a_.set().ball) * unitsPerMetre);
        p.a = p.a + reach;
        p.w = p.w - reach;
        lower = lower - ballReach(a_, search.normal) * unitsPerMetre;
      }
      if (b_.set().ball > 0) {
        p.w = p.w - ballPoint(b_, n) * (Real(b_.set().ball) * unitsPerMetre);
        lower = lower - ballReach(b_, search.normal) * unitsPerMetre;
      }
    }
    ConvexDistance result;
    result.distance = std::max(search.unit * static_cast<double>(gjk::length(p.w)),
                               std::numeric_limits<double>::min());
    // 2^-89 covers some dozen roundings, each of 2^-98 of the size. `roundedDown` covers the
    // rounding to double.
    result.lower = roundedDown(search.unit * static_cast<double>(lower - Real(0x1p-89)));
    result.normal_W = rounded(search.normal, 1);
    result.p_WA = rounded(p.a, search.unit);
    result.p_WB = rounded(p.a + p.w, search.unit);
    return result;
  }

 private:
  const PosedSet &a_, &b_;
  double size_, radii_, error_;
};

}  // namespace

ConvexDistance convexDistance(const PosedSet& a, const PosedSet& b, double relative,
                              double absolute, ConvexCache* cache) {
  const Pair pair(a, b);
  // Searches end when half of the allowed error is reached, because rounding may take the other
  // half. 1e-12 > 2^-40, so half of the promised relative error is above 2^-41. The promised
  // absolute error is 4·2^-53·S = 2^-51·S. Half of this is above 2^-55·`size`, because ‖M‖|p| + |t|
  // is below 3.5 S, so `size`, the sum over both sets, is below 7 S.
  const double share = relative / 2 + 0x1p-41, least = absolute / 2 + 0x1p-55 * pair.size();
  const auto never = [](const Vec3&, double, std::uint32_t, std::uint32_t) { return false; };
  const auto agreed = [&](double radii, double near, double finest) {
    return [=](const auto& upper, const auto& lower) {  // both have the scalar type of the search
      return static_cast<double>(upper) <= near ||
             static_cast<double>(upper - lower) <=
                 std::max(finest, share * (static_cast<double>(lower) - radii) + least);
    };
  };
  const auto accurateEnough = [&](const ConvexDistance& d, double error) {
    return d.distance + error - d.lower <= 2 * (share * d.lower + least);
  };

  gjk::Search<double> quick(a, b, pair.size());
  // The search also ends when the bounds differ by at most 2^-50·size, because in double they
  // cannot come closer.
  const gjk::Answer found =
      quick.run(gjk::startOf<double>(cache),
                agreed(pair.radii(), pair.touchDistance(), 0x1p-50 * pair.size()), never);
  gjk::keep(quick.simplex, cache);
  const auto count = [cache](const gjk::Answer& search) {
    if (cache) cache->rounds += search.rounds + 1;
  };
  if (cache) cache->rounds = 0;
  count(found);
  const bool met = found.overlap || found.upper <= pair.touchDistance();
  const double gap = pair.gap(found, quick);
  bool exact = false;
  if (!(gap > pair.band())) {
    const bool balls = a.keepsBall() && b.keepsBall();
    const bool deep = found.overlap || found.upper + pair.band() <= pair.radii();
    const PredicateResult touch = deep && balls ? PredicateResult{true} : convexSetsTouch(a, b);
    exact = touch.exact;
    if (touch) {
      if (met && balls && pair.met(quick)) {
        ConvexDistance contact = pair.contact(quick, Spheres::aroundCores);
        contact.exact = exact;
        return contact;
      }
      gjk::Search<DoubleDouble> finer(a, b, pair.size(), !balls);
      const double near = pair.touchDistance() - (balls ? 0 : pair.radii());
      count(finer.run(quick.simplex, agreed(HUGE_VAL, near, 0x1p-50 * pair.size()), never));
      ConvexDistance contact = pair.contact(finer, balls ? Spheres::aroundCores : Spheres::inCores);
      contact.exact = true;
      return contact;
    }
  }

  ConvexDistance result;
  if (!met) {
    result = pair.apart(quick, Spheres::aroundCores);
    result.lower = gap;
    result.exact = exact;
    if (accurateEnough(result, pair.error())) return result;
  }
  gjk::Search<DoubleDouble> finer(a, b, pair.size());
  count(finer.run(quick.simplex, agreed(pair.radii(), -1, 0), never));
  result = pair.apart(finer, Spheres::aroundCores);
  result.exact = true;
  if (accurateEnough(result, 0) || pair.radii() == 0) return result;
  gjk::Search<DoubleDouble> withBalls(a, b, pair.size(), true);
  count(withBalls.run(finer.simplex, agreed(0, -1, 0), never));
  ConvexDistance other = pair.apart(withBalls, Spheres::inCores);
  other.exact = true;
  return other.distance - other.lower < result.distance - result.lower ? other : result;
}

ConvexDistance separatedDistance(const PosedSet& a, const PosedSet& b, const ConvexCache& from) {
  const Pair pair(a, b);
  const auto done = [](const auto& upper, const auto& lower) {
    return static_cast<double>(upper - lower) <= 0;
  };
  const auto never = [](const Vec3&, double, std::uint32_t, std::uint32_t) { return false; };
  gjk::Search<DoubleDouble> search(a, b, pair.size());
  search.run(gjk::startOf<DoubleDouble>(&from), done, never);
  ConvexDistance result = pair.apart(search, Spheres::aroundCores);
  // If the maps are not rigid, the spheres must be parts of the cores (as in `convexDistance`).
  if (pair.radii() > 0 && !(a.keepsBall() && b.keepsBall())) {
    gjk::Search<DoubleDouble> withBalls(a, b, pair.size(), true);
    withBalls.run(search.simplex, done, never);
    const ConvexDistance other = pair.apart(withBalls, Spheres::inCores);
    if (!(other.distance - other.lower >= result.distance - result.lower)) result = other;
  }
  result.lower = result.lower > 0 ? result.lower : 0;  // NaN if no gap was found
  result.exact = true;
  return result;
}

ConvexRange convexDistanceRange(const PosedSet& a, const PosedSet& b, double beyond, double near) {
  const Pair pair(a, b);
  gjk::Search<double> search(a, b, pair.size());
  double lower = 0;
  const gjk::Answer found = search.run(
      gjk::Simplex<double>(),
      [&](double upper, double gap) {
        return upper <= pair.touchDistance() || upper - pair.radii() + pair.error() <= near ||
               upper - gap <= std::max(0x1p-50 * pair.size(), 0x1p-20 * (gap - pair.radii()));
      },
      [&](const Vec3& n, double gap, std::uint32_t pointA, std::uint32_t pointB) {
        if (!(gap - pair.radii() > beyond)) return false;
        lower = pair.gap(n, pointA, pointB);
        return lower > beyond;
      });
  if (found.overlap) return {0, 0};
  if (!found.accepted) lower = pair.gap(found, search);
  // Points of the cores are points of the sets, so their distance is an upper bound.
  ConvexRange range{0, found.upper + pair.error()};
  if (lower > pair.band()) range.lower = lower;
  if (search.simplex.count > 0 && found.upper > pair.touchDistance())
    range.upper =
        std::min(range.upper, pair.apart(search, Spheres::aroundCores).distance + pair.error());
  if (!(range.upper >= 0)) range.upper = HUGE_VAL;  // NaN after overflow: no upper bound
  return range;
}

}  // namespace corridor
