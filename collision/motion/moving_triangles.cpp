#include "collision/motion/moving_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/distance_triangle_triangle.h"

namespace corridor {

MovingTrianglesAnswer decideMovingTriangles(const Triangle& a, const Triangle& b,
                                            const MotionWindow& window, double margin,
                                            Counters& counters) {
  ++counters.triangleTests;
  Triangle lever, posed;  // b's corners from the reference point, and in the world; rounded
  double size = window.X_WB.t.cwiseAbs().maxCoeff();
  for (int i = 0; i < 3; ++i) {
    lever[i] = window.X_WB.m * b[i];
    posed[i] = lever[i] + window.X_WB.t;
  }
  double largest = 0;
  for (int i = 0; i < 3; ++i)
    largest = std::max({largest, lever[i].cwiseAbs().maxCoeff(), a[i].cwiseAbs().maxCoeff()});
  size += largest;
  // With |n|₁ ≤ √3(1 + 4u) and S = `size` above every coordinate: n·p has three products, 3·√3·uS
  // < 5.2uS on either side; a posed coordinate is off by 4.1u(3|y| + |t|) < 12.3uS, √3 of it along
  // n: 21.3uS; the difference rounds 4uS more. Together < 36uS.
  const double slack = 64 * kUnit * size + kTiny;

  const ClosestPoints closest = closestFeaturePoints(a, posed);
  const double distance = std::sqrt(closest.squaredDistance);
  const Vec3 n =
      (closest.b - closest.a) / distance;  // NaN where they meet: nothing is separated then

  MovingTrianglesAnswer answer;
  double lowest = std::numeric_limits<double>::infinity(), lowestMid = lowest, lowestStill = lowest;
  for (int i = 0; i < 3; ++i) {
    const Vec3 spin = window.angular.cross(lever[i]);
    const double turn = spin.norm();
    const double reach = lever[i].norm();
    const double cap = window.speed + turn * (1 + 8 * kUnit) + 8 * kUnit * window.angle * reach;
    // Second order as in `MotionWindow`, but along n itself: ½|n·(ω × (ω × y))| + (α²/6)|n·(ω ×
    // y)|. The products' own rounding, relative to their terms (α ≤ π/2): 32u of |v| + α|y|.
    const double directional = std::abs(n.dot(window.linear + spin)) +
                               0.5 * std::abs(n.dot(window.angular.cross(spin))) +
                               window.angle * window.angle / 6 * std::abs(n.dot(spin)) +
                               32 * kUnit * (window.speed + window.angle * reach);
    const double travel = roundedUp(std::min(cap, directional));
    const double error = roundedUp(window.fixedError + window.reachError * reach);
    const double along = n.dot(posed[i]);
    lowest = std::min(lowest, along - travel - error);
    lowestMid = std::min(lowestMid, along);
    lowestStill = std::min(lowestStill, along - error);
    answer.travel = std::max(answer.travel, roundedUp(cap));
  }
  const double highest = std::max({n.dot(a[0]), n.dot(a[1]), n.dot(a[2])});
  // |n| ≤ 1 + 4u: the margin and errors, lengths along a unit vector, shrink by less than `slack`
  // covers of their size.
  const double needed = margin + slack + 4 * kUnit * margin;
  if (lowest - highest > needed) {
    answer.separated = true;
    return answer;
  }
  answer.gap = std::max(0.0, distance - margin);
  const bool apart =
      lowestMid - highest > slack;  // a proof for the rounded pose itself: no exact test needed
  if (margin > 0 && distance + slack <= margin) {
    answer.contact = true;
  } else if (!apart) {
    answer.contact = trianglesTouch(a, {}, b, window.X_WB, counters);
    --counters.triangleTests;  // the same pair
  }
  answer.stuck = !answer.contact && !(lowestStill - highest > needed);
  return answer;
}

}  // namespace corridor
