#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"
#include "collision/convex/point_columns.h"
#include "collision/core/rounding.h"
#include "collision/motion/relative_motion.h"

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
/// * The cross product and the sum are off by 4u(1 + α), which adds 8u(1 + α) of the reach.
/// * n·linear adds 4u of `speed`, and the sum with it 2u of `speed`.
/// * The sums add 3u of all terms, and 2u(1 + α) of the reach.
/// * n × angular in the remainder is off by 4uα.
/// * What the bound of `PosedSet` has more for the vector's length than for |n| ≤ 1: 20uα of the
///   reach, and 6uα of |t|.
/// The factor 48u covers all together. In `moving`, for points in columns, n and n × angular are
/// projected separately, by Mᵀn and Mᵀ(n × angular): each has the errors of one projection, which
/// is linear in the vector's length, and their sum has the length 1 + α as well.
namespace corridor {

/// The gap of two sets along a direction, metres. `moving` is a lower bound of the gap in the
/// interval. `middle` is the gap at the rounded pose at the middle. `still` is `middle` minus
/// rounding and tube.
struct Gaps {
  double moving, middle, still;
};

/// Two convex sets in a time interval: a is at rest, b moves. Holds everything that does not depend
/// on the direction. The views of the sets must outlive the object.
class MovingSets {
 public:
  /// @param center, radius a sphere about the core of b, in b's frame, metres.
  MovingSets(const ConvexSet& a, const ConvexSet& b, const RelativeMotion& relative,
             const Vec3& center, double radius)
      : relative_(relative), a_(a, {}), b_(b, relative.X_AB) {
    // The rounded map M is within reachError of a rotation. Differences of points are off by 2u of
    // their terms.
    const double grown = radius * (1 + relative.reachError) + 4 * kUnit * b_.reach();
    bound_ = motionBound(relative, relative.X_AB * center, roundedUp(grown));

    const double reach = a_.reach() + b_.reach();
    size_ = reach + relative.X_AB.t.norm();
    const double terms = size_ + relative.speed;
    slack_ = roundedUp(a_.error() + b_.error() + 4 * kUnit * terms);
    movingSlack_ = roundedUp(48 * kUnit *
                             ((1 + relative.angle) * (terms + bound_.secondOrderAcross) +
                              bound_.secondOrder + bound_.pad));
  }

  /// Returns the gaps along n, off by at most `slack`. @pre |n| ≤ 1 + 5u.
  Gaps along(const Vec3& n) const {
    const double highest = a_.highest(n), lowest = -b_.highest(-n);
    Gaps gaps;
    gaps.middle = lowest - highest;
    gaps.still = gaps.middle - bound_.pad;
    gaps.moving =
        std::max(lowestMoving(n), lowest - bound_.isotropic) - highest - bound_.pad - movingSlack_;
    return gaps;
  }
  /// Returns a lower bound of the gap along n in the interval, off by at most `slack`: that of the
  /// first-order terms, without the second bound. @pre |n| ≤ 1 + 5u.
  double moving(const Vec3& n) const {
    return lowestMoving(n) - a_.highest(n) - bound_.pad - movingSlack_;
  }

  /// Returns the value that a member of `Gaps` must exceed to prove that the sets keep the margin.
  /// Since |n| ≤ 1 + 4u, gaps along n may be too large by this factor. The last term covers this.
  double needed(double margin) const { return margin + slack_ + 8 * kUnit * (margin + radii()); }

  const PosedSet& a() const { return a_; }
  const PosedSet& b() const { return b_; }
  const MotionBound& bound() const { return bound_; }
  double radii() const { return a_.set().ball + b_.set().ball; }
  double size() const { return size_; }
  /// The error that the projections cause in each member of `Gaps`, metres. The rounding of the
  /// motion is already subtracted in `Gaps::moving`.
  double slack() const { return slack_; }

 private:
  /// Returns a lower bound of n·x for the points x of b in the interval, by first-order terms.
  double lowestMoving(const Vec3& n) const {
    const Vec3 across = n.cross(relative_.angular);
    return n.dot(relative_.X_AB.t) + coreLowest(n, across) - b_.set().ball -
           roundedUp(bound_.secondOrderAcross * across.norm() + bound_.secondOrder);
  }
  /// Returns the least of s·n·linear + (n + s·across)·M p over the points p of the core, |s| ≤ 1.
  double coreLowest(const Vec3& n, const Vec3& across) const {
    const Mat3& M = relative_.X_AB.m;
    const double linear = n.dot(relative_.linear);
    if (const PointColumns* columns = b_.set().columns)
      return columns->leastAround(M.transpose() * n, M.transpose() * across, linear);
    return std::min(linear - b_.coreHighest(-(M.transpose() * (n + across))),
                    -linear - b_.coreHighest(-(M.transpose() * (n - across))));
  }

  const RelativeMotion& relative_;
  PosedSet a_, b_;
  MotionBound bound_;
  double size_ = 0, slack_ = 0, movingSlack_ = 0;
};

}  // namespace corridor
