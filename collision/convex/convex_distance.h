#pragma once

#include "collision/convex/convex_set.h"
#include "collision/core/counters.h"

namespace corridor {

/// How far two convex sets are apart, metres.
struct ConvexDistance {
  double distance = 0;           ///< of the two points; 0: they touch
  double lower = 0;              ///< proved: they are at least this far apart
  Vec3 normal_W = Vec3::Zero();  ///< the direction that proved it, from a to b: unit, rounded
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
};

/// The distance of two convex sets, each under its own map, and points of either that have it.
///
/// 0 if and only if `convexSetsTouch`; then both points are one that both sets have (in its band:
/// up to the band; where they overlap by less than 2^-30·S: up to that). Else `distance` is above
/// the true one by at most relative·true + absolute, and, whatever is asked, by 1e-12·true +
/// 4·2^-53·S, S the largest Σ|m||p| + |t| of the points mapped, each of the two with its radii (of
/// maps that aren't rigid: the largest ‖M‖|p| + |t|, ‖M‖ at least 1); `lower` ≤ true is proved in
/// real arithmetic and tells how well it went. The points are on the sets' surfaces up to 2^-50·S.
/// Any finite maps: a ball under one that isn't rigid is an ellipsoid, which takes longer.
///
/// GJK in double; where its bounds, all rounding covered, don't agree to what is asked, again in
/// double-double, beginning with the corners that it found: by default nearly always where they are
/// closer than a hundredth of the size. On curved surfaces every other direction is a step of
/// Newton's. In the mean 2 to 5 rounds, with a cylinder 2 to 20, and less than 2 in double-double;
/// 100 at most in tests down to gaps of 10^-13 (`tests/collision/convex/gjk_test.cpp` prints them).
/// @param relative, absolute  not negative; metres. 0: the last digits.
ConvexDistance convexDistance(const PosedSet& a, const PosedSet& b, double relative,
                              double absolute, Counters& counters);

/// A proved range of their distance, in double. lower > 0: they don't touch. Both ends are within
/// some 2^-45·S of the distance, or 2^-20 of it, but where caps of cylinders face each other or a
/// ball's map isn't rigid; or it ended as soon as lower exceeded `beyond` or upper was no more than
/// `near`. @param beyond, near  metres.
struct ConvexRange {
  double lower = 0, upper = 0;
};
ConvexRange convexDistanceRange(const PosedSet& a, const PosedSet& b, double beyond, double near,
                                Counters& counters);

}  // namespace corridor
