#include "collision/motion/moving_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"
#include "collision/convex/gjk.h"
#include "collision/core/rounding.h"

/// Derivation. Along a unit vector n, the gap at the time s of the interval, |s| ≤ 1, is
///   g(s) = min over b of n·x(s) − max over a of n·x.
/// b is a core swept by a sphere. The real motion is rigid, so the sphere reduces the gap by its
/// radius at every s, and only the motion of the core matters. (The disc of a cylinder rotates with
/// the body; its points are points of the core.) Let x = t + y be a point of b at the middle, with
/// y = M p. Here p is the point in the frame of b, and M and t are the members of `X_AB`. By
/// `RelativeMotion` and `MotionBound`,
///   n·x(s) ≥ n·x + s n·(linear + angular × y) − secondOrderAcross |n × angular| − secondOrder −
///   pad.
/// Since n·(angular × y) = (n × angular)·y, the minimum of the first-order terms over *all* points
/// of the core is
///   min over p of n·t + s n·linear + (n + s n × angular)·M p.
/// This is again a projection of the core, along another vector. It is a minimum of functions that
/// are linear in s, hence concave in s. Its least value on |s| ≤ 1 is therefore at s = 1 or s = −1.
/// A second lower bound is the least n·x at the middle, less `isotropic` and `pad`.
///
/// Rounding. The bound of `PosedSet` is linear in the length of the vector, which is at most 1 + α
/// with α = `angle`. Other errors are added:
/// * The cross product and the sum are off by 4u(1 + α), which adds 8u of the reach.
/// * n·linear adds 4u of `speed`.
/// * The sums add 3u of all terms.
/// * n × angular in the remainder is off by 4uα.
/// The factor 32u covers all four together.
namespace corridor {
namespace {

/// The gap of two sets along a direction. `moving` is a lower bound of the gap in the interval.
/// `middle` is the gap at the rounded pose at the middle. `still` is `middle` minus rounding and
/// tube.
struct Gaps {
  double moving, middle, still;
};

/// A pair of convex sets in a time interval: everything that does not depend on the direction.
class MovingPair {
 public:
  MovingPair(const ConvexSet& a, const ConvexSet& b, const RelativeMotion& relative)
      : relative_(relative), a_(a, {}), b_(b, relative.X_AB) {
    Vec3 low = b.points[0], high = low;
    for (const Vec3& p : b.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const Vec3 center = low + 0.5 * (high - low);
    double square = 0;
    for (const Vec3& p : b.points) square = std::max(square, (p - center).squaredNorm());
    // The rounded map M is within reachError of a rotation. Differences of points are off by 2u of
    // their terms.
    const double radius =
        (std::sqrt(square) + b.disc) * (1 + relative.reachError) + 4 * kUnit * b_.reach();
    bound_ = motionBound(relative, relative.X_AB * center, roundedUp(radius));

    const double reach = a_.reach() + b_.reach();
    size_ = reach + relative.X_AB.t.norm();
    const double terms = size_ + relative.speed;
    slack_ = roundedUp(a_.error() + b_.error() + 4 * kUnit * terms);
    movingSlack_ = roundedUp(32 * kUnit *
                             ((1 + relative.angle) * (terms + bound_.secondOrderAcross) +
                              bound_.secondOrder + bound_.pad));
  }

  Gaps along(const Vec3& n) const {
    const double highest = a_.highest(n), lowest = -b_.highest(-n);
    const Vec3 across = n.cross(relative_.angular);
    const double first = std::min(coreLowest(n, across, 1), coreLowest(n, across, -1)) -
                         b_.set().ball -
                         roundedUp(bound_.secondOrderAcross * across.norm() + bound_.secondOrder);
    Gaps gaps;
    gaps.middle = lowest - highest;
    gaps.still = gaps.middle - bound_.pad;
    gaps.moving = std::max(first, lowest - bound_.isotropic) - highest - bound_.pad - movingSlack_;
    return gaps;
  }

  const PosedSet& a() const { return a_; }
  const PosedSet& b() const { return b_; }
  const MotionBound& bound() const { return bound_; }
  double radii() const { return a_.set().ball + b_.set().ball; }
  double size() const { return size_; }
  /// The error that the projections cause in each member of `Gaps`, metres. The rounding of the
  /// motion is already subtracted in `Gaps::moving`.
  double slack() const { return slack_; }

 private:
  double coreLowest(const Vec3& n, const Vec3& across, double s) const {
    const Transform& X = relative_.X_AB;
    return n.dot(X.t) + s * n.dot(relative_.linear) -
           b_.coreHighest(-(X.m.transpose() * (n + s * across)));
  }

  const RelativeMotion& relative_;
  PosedSet a_, b_;
  MotionBound bound_;
  double size_ = 0, slack_ = 0, movingSlack_ = 0;
};

MovingPairAnswer decide(const ConvexSet& a, const ConvexSet& b, const RelativeMotion& relative,
                        double margin) {
  const MovingPair pair(a, b, relative);
  // Since |n| ≤ 1 + 4u, gaps along n may be too large by this factor. The last term of the sum
  // covers this.
  const double needed = margin + pair.slack() + 8 * kUnit * (margin + pair.radii());
  const double near = pair.radii() + 0x1p-49 * pair.size();  // within the band of `convexSetsTouch`

  MovingPairAnswer answer;
  const double none = -std::numeric_limits<double>::infinity();
  Gaps best{none, none, none};
  const auto attempt = [&](const Vec3& n, double coreGap, std::uint32_t, std::uint32_t) {
    if (!(coreGap > near)) return false;
    const Gaps gaps = pair.along(n);
    best = {std::max(best.moving, gaps.moving), std::max(best.middle, gaps.middle),
            std::max(best.still, gaps.still)};
    return gaps.moving > needed;
  };
  const auto apart = [&] {
    return MovingPairAnswer{
        .separated = true, .clearance = roundedDown(best.moving - needed), .exact = answer.exact};
  };
  gjk::Answer found = gjk::search<double>(pair.a(), pair.b(), pair.size(), near, attempt);
  if (found.accepted) return apart();
  const bool met = found.overlap || found.upper <= near;
  // The sets do not meet, but the tilt of n reduces the gap to nothing, or by more than a quarter:
  // search again with more digits.
  if (!met && !(best.middle > pair.slack() &&
                best.middle - margin > 0.75 * (found.upper - pair.radii() - margin))) {
    answer.exact = true;
    found = gjk::search<DoubleDouble>(pair.a(), pair.b(), pair.size(), near, attempt);
    if (found.accepted) return apart();
  }
  const double distance = met ? 0 : std::max(0.0, found.upper - pair.radii());
  answer.bound = pair.bound().isotropic;
  answer.gap = std::max(0.0, distance - margin);
  answer.contact =
      !(best.middle > pair.slack()) || (margin > 0 && distance + pair.slack() <= margin);
  answer.stuck = !answer.contact && !(best.still > needed);
  return answer;
}

}  // namespace

MovingPairAnswer decideMovingParts(const ConvexPart& a, const ConvexPart& b,
                                   const RelativeMotion& relative, double margin) {
  return decide(a, b, relative, margin);
}

MovingPairAnswer decideMovingParts(const Triangle& a, const ConvexPart& b,
                                   const RelativeMotion& relative, double margin) {
  return decide(a, b, relative, margin);
}

MovingPairAnswer decideMovingParts(const ConvexPart& a, const Triangle& b,
                                   const RelativeMotion& relative, double margin) {
  return decide(a, b, relative, margin);
}

}  // namespace corridor
