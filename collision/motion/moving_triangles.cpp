#include "collision/motion/moving_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/distance_triangle_triangle.h"

namespace corridor {
namespace {

/// The corners of b, and what each of them does in the window whatever the direction.
struct MovingCorners {
  Triangle lever, posed,
      spin;  ///< b's corners from the reference point, and in the world; ω × lever
  Vec3 reach, cap, error;

  MovingCorners(const Triangle& b, const MotionWindow& window) {
    for (int i = 0; i < 3; ++i) {
      lever[i] = window.X_WB.m * b[i];
      posed[i] = lever[i] + window.X_WB.t;
      spin[i] = window.angular.cross(lever[i]);
      reach[i] = lever[i].norm();
      cap[i] =
          window.speed + spin[i].norm() * (1 + 8 * kUnit) + 8 * kUnit * window.angle * reach[i];
      error[i] = roundedUp(window.fixedError + window.reachError * reach[i]);
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

Gaps gapsAlong(const Vec3& n, const Triangle& a, const MovingCorners& b,
               const MotionWindow& window) {
  Gaps gaps;
  const double highest = std::max({n.dot(a[0]), n.dot(a[1]), n.dot(a[2])});
  for (int i = 0; i < 3; ++i) {
    const Vec3& spin = b.spin[i];
    // Second order as in `MotionWindow`, but along n itself: ½|n·(ω × (ω × y))| + (α²/6)|n·(ω ×
    // y)|. The products' own rounding, relative to their terms (α ≤ π/2): 32u of |v| + α|y|.
    const double directional = std::abs(n.dot(window.linear + spin)) +
                               0.5 * std::abs(n.dot(window.angular.cross(spin))) +
                               window.angle * window.angle / 6 * std::abs(n.dot(spin)) +
                               32 * kUnit * (window.speed + window.angle * b.reach[i]);
    const double travel = roundedUp(std::min(b.cap[i], directional));
    const double along = n.dot(b.posed[i]);
    lower(gaps.moving, along - travel - b.error[i] - highest);
    lower(gaps.middle, along - highest);
    lower(gaps.still, along - b.error[i] - highest);
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

}  // namespace

MovingTrianglesAnswer decideMovingTriangles(const Triangle& a, const Triangle& b,
                                            const MotionWindow& window, double margin,
                                            Counters& counters) {
  ++counters.triangleTests;
  const MovingCorners corners(b, window);
  const Triangle& posed = corners.posed;
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    largest =
        std::max({largest, corners.lever[i].cwiseAbs().maxCoeff(), a[i].cwiseAbs().maxCoeff()});
  const double size = window.X_WB.t.cwiseAbs().maxCoeff() + largest;
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
  Gaps gaps = gapsAlong(n, a, corners, window);
  if (gaps.moving > needed) {
    answer.separated = true;
    return answer;
  }
  answer.travel = roundedUp(corners.cap.maxCoeff());
  answer.gap = std::max(0.0, distance - margin);
  if (margin > 0 && distance + slack <= margin) {
    answer.contact = true;
  } else if (!(gaps.middle > slack)) {  // else a proof for the rounded pose itself
    answer.contact = trianglesTouch(a, {}, b, window.X_WB, counters);
    --counters.triangleTests;  // the same pair
  }
  if (answer.contact) return answer;

  // A quarter of the gap lost to the tilt of n: look for a better direction before giving up.
  if (gaps.middle - margin < 0.75 * (distance - margin)) {
    offerFeatureDirections(a, posed, n, [&](const Vec3& m) {
      const Gaps other = gapsAlong(m, a, corners, window);
      if (other.moving > gaps.moving) gaps.moving = other.moving;
      if (other.still > gaps.still) gaps.still = other.still;
    });
    if (gaps.moving > needed) {
      answer.separated = true;
      return answer;
    }
  }
  answer.stuck = !(gaps.still > needed);
  return answer;
}

}  // namespace corridor
