#include "collision/motion/moving_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"
#include "collision/convex/gjk.h"
#include "collision/core/rounding.h"

/// Derivation. Along a unit n the gap at the place s of the window is
///   g(s) = min over b of n·x(s) − max over a of n·x.
/// b is a core swept by a ball. The real motion is rigid, so the ball's share is its radius at
/// every s and only core points travel (a disc does turn with its cylinder: its points are core
/// points). With x = t + y, y = M p, (`MotionWindow`, `PointTravel`)
///   n·x(s) ≥ n·x + s n·(linear + angular × y) − bend |n × angular| − curvature − pad,
/// and n·(angular × y) = (n × angular)·y, so that all the core's points *jointly* give
///   min over p of n·t + s n·linear + (n + s n × angular)·M p:
/// a projection of the core again, along another vector; being the minimum of functions linear in
/// s it is concave, so its least value on |s| ≤ 1 is at s = ±1. The isotropic bound, the projection
/// along n less `cap` and `pad`, holds as well.
///
/// Rounding. As in `PosedSet`, whose bound is linear in the length of the vector, at most 1 + α of
/// it with α = `angle` (+8u: cross product and sum, off by 4u(1 + α) of the reach); n·linear 4u of
/// `speed`; sums 3u of all terms. n × angular in the remainder is off by 4uα. 32u covers each.
namespace corridor {
namespace {

/// How far apart two sets are along a direction: all along the window, at the middle's rounded
/// pose, and at the middle with rounding and tube.
struct Gaps {
  double moving, middle, still;
};

/// A pair of convex sets in a window, and what does not depend on a direction.
class MovingPair {
 public:
  MovingPair(const ConvexSet& a, const ConvexSet& b, const MotionWindow& window)
      : window_(window), a_(a, {}), b_(b, window.X_AB) {
    Vec3 low = b.points[0], high = low;
    for (const Vec3& p : b.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const Vec3 center = low + 0.5 * (high - low);
    double square = 0;
    for (const Vec3& p : b.points) square = std::max(square, (p - center).squaredNorm());
    // The rounded map M is within reachError of a rotation; differences of points are off by 2u of
    // their terms.
    const double radius =
        (std::sqrt(square) + b.disc) * (1 + window.reachError) + 4 * kUnit * b_.reach();
    travel_ = travelOf(window, window.X_AB * center, roundedUp(radius));

    const double reach = a_.reach() + b_.reach();
    size_ = reach + window.X_AB.t.norm();
    const double terms = size_ + window.speed;
    slack_ = roundedUp(a_.error() + b_.error() + 4 * kUnit * terms);
    movingSlack_ =
        roundedUp(32 * kUnit *
                  ((1 + window.angle) * (terms + travel_.bend) + travel_.curvature + travel_.pad));
  }

  Gaps along(const Vec3& n) const {
    const double highest = a_.highest(n), lowest = -b_.highest(-n);
    const Vec3 across = n.cross(window_.angular);
    const double first = std::min(coreLowest(n, across, 1), coreLowest(n, across, -1)) -
                         b_.set().ball -
                         roundedUp(travel_.bend * across.norm() + travel_.curvature);
    Gaps gaps;
    gaps.middle = lowest - highest;
    gaps.still = gaps.middle - travel_.pad;
    gaps.moving = std::max(first, lowest - travel_.cap) - highest - travel_.pad - movingSlack_;
    return gaps;
  }

  const PosedSet& a() const { return a_; }
  const PosedSet& b() const { return b_; }
  const PointTravel& travel() const { return travel_; }
  double radii() const { return a_.set().ball + b_.set().ball; }
  double size() const { return size_; }
  /// Of `middle` and `still`, and, on top of its own, of `moving`.
  double slack() const { return slack_; }

 private:
  double coreLowest(const Vec3& n, const Vec3& across, double s) const {
    const Transform& X = window_.X_AB;
    return n.dot(X.t) + s * n.dot(window_.linear) -
           b_.coreHighest(-(X.m.transpose() * (n + s * across)));
  }

  const MotionWindow& window_;
  PosedSet a_, b_;
  PointTravel travel_;
  double size_ = 0, slack_ = 0, movingSlack_ = 0;
};

MovingTrianglesAnswer decide(const ConvexSet& a, const ConvexSet& b, const MotionWindow& window,
                             double margin, Counters& counters) {
  ++counters.triangleTests;
  const MovingPair pair(a, b, window);
  // |n| ≤ 1 + 4u: margin and pad, lengths along a unit vector, may be that much too short.
  const double needed = margin + pair.slack() + 8 * kUnit * (margin + pair.radii());
  const double near = pair.radii() + 0x1p-49 * pair.size();  // in the band: `convexSetsTouch`

  MovingTrianglesAnswer answer;
  const double none = -std::numeric_limits<double>::infinity();
  Gaps best{none, none, none};
  const auto attempt = [&](const Vec3& n, double coreGap) {
    if (!(coreGap > near)) return false;
    const Gaps gaps = pair.along(n);
    best = {std::max(best.moving, gaps.moving), std::max(best.middle, gaps.middle),
            std::max(best.still, gaps.still)};
    return gaps.moving > needed;
  };
  const auto apart = [&] {
    return MovingTrianglesAnswer{.separated = true, .clearance = roundedDown(best.moving - needed)};
  };
  gjk::Answer found = gjk::search<double>(pair.a(), pair.b(), pair.size(), near, attempt);
  if (found.accepted) return apart();
  const bool met = found.overlap || found.upper <= near;
  // Not apart where the two are, or a quarter of the gap lost to the tilt of n.
  if (!met && !(best.middle > pair.slack() &&
                best.middle - margin > 0.75 * (found.upper - pair.radii() - margin))) {
    ++counters.exactTests;
    found = gjk::search<DoubleDouble>(pair.a(), pair.b(), pair.size(), near, attempt);
    if (found.accepted) return apart();
  }
  const double distance = met ? 0 : std::max(0.0, found.upper - pair.radii());
  answer.travel = pair.travel().cap;
  answer.gap = std::max(0.0, distance - margin);
  answer.contact =
      !(best.middle > pair.slack()) || (margin > 0 && distance + pair.slack() <= margin);
  answer.stuck = !answer.contact && !(best.still > needed);
  return answer;
}

}  // namespace

MovingTrianglesAnswer decideMovingParts(const ConvexPart& a, const ConvexPart& b,
                                        const MotionWindow& window, double margin,
                                        Counters& counters) {
  return decide(a, b, window, margin, counters);
}

MovingTrianglesAnswer decideMovingParts(const Triangle& a, const ConvexPart& b,
                                        const MotionWindow& window, double margin,
                                        Counters& counters) {
  return decide(a, b, window, margin, counters);
}

MovingTrianglesAnswer decideMovingParts(const ConvexPart& a, const Triangle& b,
                                        const MotionWindow& window, double margin,
                                        Counters& counters) {
  return decide(a, b, window, margin, counters);
}

}  // namespace corridor
