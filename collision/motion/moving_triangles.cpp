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

/// The corners of b, and what each of them does in the window whatever the direction.
struct MovingCorners {
  Triangle posed, first;  ///< in a's frame; displacement to first order
  PointTravel travel[3];
  /// Where a single turn is all that bends the motion (`bend`), its second and third order in full:
  /// displacements of at most (½)ω × (ω × d) and α²/6 ω × d, d from the axis.
  bool turns = false;
  Triangle second, third;
  Vec3 loose;  ///< rounding of the terms above

  MovingCorners(const Triangle& b, const MotionWindow& window) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 lever = window.X_AB.m * b[i];
      posed[i] = lever + window.X_AB.t;
      first[i] = window.linear + window.angular.cross(lever);
      travel[i] = travelOf(window, posed[i], 0);
      // Products' own rounding, relative to their terms.
      loose[i] = 32 * kUnit * (window.speed + window.angle * lever.norm());
    }
    turns = travel[0].bend > 0 || travel[1].bend > 0 || travel[2].bend > 0;
    if (!turns) return;
    Vec3 point = Vec3::Zero();
    for (const ScrewTravel& screw : window.screws)
      if (screw.kind == ScrewTravel::Kind::turn && screw.amount > 0) point = screw.point;
    for (int i = 0; i < 3; ++i) {
      const Vec3 d = posed[i] - point;
      const Vec3 spin = window.angular.cross(d);
      second[i] = 0.5 * window.angular.cross(spin);
      third[i] = window.angle * window.angle / 6 * spin;
      loose[i] += 32 * kUnit * window.angle * (1 + window.angle * window.angle) *
                  (d.norm() + posed[i].cwiseAbs().sum() + window.X_AB.t.cwiseAbs().sum());
    }
  }
};

/// How far apart the triangles are along a direction: all along the window, at the middle's rounded
/// pose, and at the middle with rounding and tube.
struct Gaps {
  double moving = std::numeric_limits<double>::infinity(), middle = moving, still = moving;
};

/// Keeps NaN, which std::min may drop.
void lower(double& least, double x) {
  if (!(x >= least) && !std::isnan(least)) least = x;
}

Gaps gapsAlong(const Vec3& n, const Triangle& a, const MovingCorners& b) {
  Gaps gaps;
  const double highest = std::max({n.dot(a[0]), n.dot(a[1]), n.dot(a[2])});
  for (int i = 0; i < 3; ++i) {
    const PointTravel& travel = b.travel[i];
    // One turn: (1 − cos)|n·(k × (k × d))| + (α − sin)|n·(k × d)|, sharper than its bound by
    // `bend`.
    const double beyond = b.turns ? std::abs(n.dot(b.second[i])) + std::abs(n.dot(b.third[i])) : 0;
    const double directional = std::abs(n.dot(b.first[i])) + beyond + travel.curvature + b.loose[i];
    const double most = roundedUp(std::min(travel.cap, directional));
    const double along = n.dot(b.posed[i]);
    lower(gaps.moving, along - most - travel.pad - highest);
    lower(gaps.middle, along - highest);
    lower(gaps.still, along - travel.pad - highest);
  }
  return gaps;
}

/// v at unit length, |n| ≤ 1 + 4u; NaN, which separates nothing, where squares leave the range in
/// which that holds (flush-to-zero on or off).
Vec3 unit(const Vec3& v) {
  const double square = v.squaredNorm();
  if (!(square > 0x1p-900 && square < 0x1p900))
    return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  return v / std::sqrt(square);
}

/// Directions that are right to a few ulp whatever the triangles' sizes, on the side of `n`: the
/// closest points are rounded to u times a triangle's size L, so that their difference is tilted by
/// uL/d, and across L that takes uL²/d off a gap of d. Normals of faces, common normals of edges,
/// and n made orthogonal to an edge again are orthogonal to what they touch.
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

MovingTrianglesAnswer apart(double moving, double needed) {
  return {.separated = true, .clearance = roundedDown(moving - needed)};
}

}  // namespace

MovingTrianglesAnswer decideMovingTriangles(const Triangle& a, const Triangle& b,
                                            const MotionWindow& window, double margin,
                                            Counters& counters) {
  ++counters.triangleTests;
  const MovingCorners corners(b, window);
  const Triangle& posed = corners.posed;
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    largest = std::max(
        {largest, (posed[i] - window.X_AB.t).cwiseAbs().maxCoeff(), a[i].cwiseAbs().maxCoeff()});
  const double size = 2 * window.X_AB.t.cwiseAbs().maxCoeff() + largest;
  // With |n|₁ ≤ √3(1 + 4u) and S = `size` above every coordinate: n·p has three products, 3·√3·uS
  // < 5.2uS on either side; a posed coordinate is off by 4.1u(3|y| + |t|) < 12.3uS, √3 of it along
  // n: 21.3uS; the difference rounds 4uS more. Together < 36uS.
  const double slack = 64 * kUnit * size + kTiny;
  // |n| ≤ 1 + 4u: the margin and errors, lengths along a unit vector, shrink by less than `slack`
  // covers of their size.
  const double needed = margin + slack + 4 * kUnit * margin;

  const ClosestPoints closest = closestFeaturePoints(a, posed);
  const double distance = std::sqrt(closest.squaredDistance);
  const Vec3 n = unit(closest.b - closest.a);  // NaN where they meet: nothing is separated then

  MovingTrianglesAnswer answer;
  Gaps gaps = gapsAlong(n, a, corners);
  if (gaps.moving > needed) return apart(gaps.moving, needed);
  answer.travel = std::max({corners.travel[0].cap, corners.travel[1].cap, corners.travel[2].cap});
  answer.gap = std::max(0.0, distance - margin);
  if (margin > 0 && distance + slack <= margin) {
    answer.contact = true;
  } else if (!(gaps.middle > slack)) {  // else a proof for the rounded pose itself
    answer.contact = trianglesTouch(a, {}, b, window.X_AB, counters);
    --counters.triangleTests;  // the same pair
  }
  if (answer.contact) return answer;

  // A quarter of the gap lost to the tilt of n: look for a better direction before giving up.
  if (gaps.middle - margin < 0.75 * (distance - margin)) {
    offerFeatureDirections(a, posed, n, [&](const Vec3& m) {
      const Gaps other = gapsAlong(m, a, corners);
      if (other.moving > gaps.moving) gaps.moving = other.moving;
      if (other.still > gaps.still) gaps.still = other.still;
    });
    if (gaps.moving > needed) return apart(gaps.moving, needed);
  }
  answer.stuck = !(gaps.still > needed);
  return answer;
}

}  // namespace corridor
