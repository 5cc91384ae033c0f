#include "collision/motion/moving_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/distance_triangle_triangle.h"

namespace corridor {
namespace {

/// The corners of b and the motion bound of each of them in the interval.
struct MovingCorners {
  Triangle posed, first;  ///< corners in a's frame at the middle; their first-order displacements
  MotionBound bound[3];
  /// True if the motion's only second-order part is that of a single rotation, that is, if
  /// `secondOrderAcross` of a corner is above 0. Then the remainder beyond first order is known in
  /// full. Along n it is at most |n·second| + |n·third|, with second = ½ ω × (ω × d) and third =
  /// (α²/6) ω × d. Here ω is `angular`, α its length, and d the lever from the axis.
  bool turns = false;
  Triangle second, third;
  Vec3 loose;  ///< for each corner, a bound of the rounding of the terms above

  MovingCorners(const Triangle& b, const RelativeMotion& relative) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 lever = relative.X_AB.m * b[i];
      posed[i] = lever + relative.X_AB.t;
      first[i] = relative.linear + relative.angular.cross(lever);
      bound[i] = motionBound(relative, posed[i], 0);
      // The rounding of the products is proportional to their terms.
      loose[i] = 32 * kUnit * (relative.speed + relative.angle * lever.norm());
    }
    turns = bound[0].secondOrderAcross > 0 || bound[1].secondOrderAcross > 0 ||
            bound[2].secondOrderAcross > 0;
    if (!turns) return;
    Vec3 point = Vec3::Zero();
    for (const ScrewMotion& screw : relative.screws)
      if (screw.kind == ScrewMotion::Kind::revolute && screw.amount > 0) point = screw.point;
    for (int i = 0; i < 3; ++i) {
      const Vec3 d = posed[i] - point;
      const Vec3 spin = relative.angular.cross(d);
      second[i] = 0.5 * relative.angular.cross(spin);
      third[i] = relative.angle * relative.angle / 6 * spin;
      loose[i] += 32 * kUnit * relative.angle * (1 + relative.angle * relative.angle) *
                  (d.norm() + posed[i].cwiseAbs().sum() + relative.X_AB.t.cwiseAbs().sum());
    }
  }
};

/// The gap of the triangles along a direction. `moving` is a lower bound of the gap in the
/// interval. `middle` is the gap at the rounded pose at the middle. `still` is `middle` minus
/// rounding and tube.
struct TriangleGaps {
  double moving = std::numeric_limits<double>::infinity(), middle = moving, still = moving;
};

/// Replaces `least` by x if x is smaller or NaN. (std::min may drop a NaN.)
void lower(double& least, double x) {
  if (!(x >= least) && !std::isnan(least)) least = x;
}

TriangleGaps gapsAlong(const Vec3& n, const Triangle& a, const MovingCorners& b) {
  TriangleGaps gaps;
  const double highest = std::max({n.dot(a[0]), n.dot(a[1]), n.dot(a[2])});
  for (int i = 0; i < 3; ++i) {
    const MotionBound& bound = b.bound[i];
    // Along n, the remainder of a single rotation is at most (1 − cos α)|n·(k × (k × d))| + (α −
    // sin α)|n·(k × d)|, with k = ω/α. This is sharper than the bound by `secondOrderAcross`.
    const double beyond = b.turns ? std::abs(n.dot(b.second[i])) + std::abs(n.dot(b.third[i])) : 0;
    const double directional =
        std::abs(n.dot(b.first[i])) + beyond + bound.secondOrder + b.loose[i];
    const double most = roundedUp(std::min(bound.isotropic, directional));
    const double along = n.dot(b.posed[i]);
    lower(gaps.moving, along - most - bound.pad - highest);
    lower(gaps.middle, along - highest);
    lower(gaps.still, along - bound.pad - highest);
  }
  return gaps;
}

/// Returns v divided by its length. Rounding gives the result a length of at most 1 + 4u. If
/// squares leave the range in which this holds (with or without flush-to-zero), returns NaN, which
/// separates nothing.
Vec3 unit(const Vec3& v) {
  const double square = v.squaredNorm();
  if (!(square > 0x1p-900 && square < 0x1p900))
    return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  return v / std::sqrt(square);
}

/// Calls `attempt` with directions that are orthogonal, to a few ulp, to the features that they
/// separate, whatever the sizes of the triangles. Each points to the same side as `n`.
///
/// The direction of the closest points is less accurate. These points are rounded to u times a
/// triangle's size L. Their difference, of length d, is therefore tilted by uL/d. Across L the tilt
/// reduces a gap of d by uL²/d. The directions here are the normals of faces, the common normals of
/// edges, and n made orthogonal to each edge once more. They are orthogonal to the features that
/// they separate.
template <class Try>
void offerFeatureDirections(const Triangle& a, const Triangle& b, const Vec3& n, Try attempt) {
  const auto offer = [&](const Vec3& v) {
    const Vec3 m = unit(v);
    attempt(m.dot(n) < 0 ? Vec3(-m) : m);
  };
  Triangle edgesA, edgesB;
  for (int i = 0; i < 3; ++i) {
    edgesA[i] = a[(i + 1) % 3] - a[i];
    edgesB[i] = b[(i + 1) % 3] - b[i];
  }
  for (const Triangle* edges : {&edgesA, &edgesB}) {
    offer((*edges)[0].cross((*edges)[1]));
    for (const Vec3& e : *edges) offer(n - e * (n.dot(e) / e.squaredNorm()));
  }
  for (const Vec3& e : edgesA)
    for (const Vec3& f : edgesB) offer(e.cross(f));
}

MovingPairAnswer apart(double moving, double needed) {
  return {.separated = true, .clearance = roundedDown(moving - needed)};
}

}  // namespace

MovingPairAnswer decideMovingTriangles(const Triangle& a, const Triangle& b,
                                       const RelativeMotion& relative, double margin) {
  const MovingCorners corners(b, relative);
  const Triangle& posed = corners.posed;
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    largest = std::max(
        {largest, (posed[i] - relative.X_AB.t).cwiseAbs().maxCoeff(), a[i].cwiseAbs().maxCoeff()});
  const double size = 2 * relative.X_AB.t.cwiseAbs().maxCoeff() + largest;
  // |n|₁ ≤ √3(1 + 4u). Let S be `size`, which exceeds every coordinate. n·p has three products:
  // 3·√3·uS < 5.2uS for each triangle. A posed coordinate is off by 4.1u(3|y| + |t|) < 12.3uS;
  // along n this is √3 times as much, 21.3uS. The difference rounds by 4uS. Together: < 36uS.
  const double slack = 64 * kUnit * size + kTiny;
  // Since |n| ≤ 1 + 4u, gaps along n may be too large by the factor 1 + 4u. `slack` is
  // large enough for this factor on the errors; the last term is this factor on the margin.
  const double needed = margin + slack + 4 * kUnit * margin;

  const ClosestPoints closest = closestFeaturePoints(a, posed);
  const double distance = std::sqrt(closest.squaredDistance);
  const Vec3 n = unit(closest.b - closest.a);  // NaN if the triangles meet; it separates nothing

  MovingPairAnswer answer;
  TriangleGaps gaps = gapsAlong(n, a, corners);
  if (gaps.moving > needed) return apart(gaps.moving, needed);
  answer.bound = std::max(
      {corners.bound[0].isotropic, corners.bound[1].isotropic, corners.bound[2].isotropic});
  answer.gap = std::max(0.0, distance - margin);
  if (margin > 0 && distance + slack <= margin) {
    answer.contact = true;
  } else if (!(gaps.middle > slack)) {
    // If gaps.middle > slack, n separates the triangles at the rounded pose, and this test is not
    // needed.
    const PredicateResult touch = trianglesTouch(a, {}, b, relative.X_AB);
    answer.contact = touch;
    answer.exact = touch.exact;
  }
  if (answer.contact) return answer;

  // If the tilt of n reduces the gap by more than a quarter, try better directions before giving
  // up.
  if (gaps.middle - margin < 0.75 * (distance - margin)) {
    offerFeatureDirections(a, posed, n, [&](const Vec3& m) {
      const TriangleGaps other = gapsAlong(m, a, corners);
      if (other.moving > gaps.moving) gaps.moving = other.moving;
      if (other.still > gaps.still) gaps.still = other.still;
    });
    if (gaps.moving > needed) {
      MovingPairAnswer proved = apart(gaps.moving, needed);
      proved.exact = answer.exact;
      return proved;
    }
  }
  answer.stuck = !(gaps.still > needed);
  return answer;
}

}  // namespace corridor
