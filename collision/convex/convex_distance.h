#pragma once

#include "collision/convex/convex_cache.h"
#include "collision/convex/convex_set.h"

namespace corridor {

/// The distance of two convex sets, with witness points and a proved lower bound; metres.
struct ConvexDistance {
  double distance = 0;           ///< distance of the witness points; 0: the sets touch
  double lower = 0;              ///< proved lower bound of the distance
  Vec3 normal_W = Vec3::Zero();  ///< the direction that proves `lower`, from a to b: unit, rounded;
                                 ///< 0 if the sets touch
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();  ///< witness points of a and b
  bool exact = false;                             ///< the search used double-double
};

/// Computes the distance of two convex sets, each under its own affine map, and witness points.
///
/// Let x ↦ M x + t be the map of a set. Let S be the largest Σ_k |M_ik||p_k| + |t_i| over all
/// coordinates i and all points p of both sets, radii included. (For maps that are not rigid: the
/// largest ‖M‖_F·|p| + |t|.) Guaranteed:
/// * `distance` is 0 if and only if `convexSetsTouch` returns true. Then both witness points are
///   the same point. This point lies in both sets, up to the band of `convexSetsTouch`, or up to
///   2^-30·S if the sets overlap by less than 2^-30·S.
/// * Otherwise `distance` exceeds the true distance d by at most relative·d + absolute + 1e-12·d +
///   4·2^-53·S.
/// * `lower` is at most the true distance, proved in real arithmetic. Up to rounding, the error of
///   `distance` is at most `distance` − `lower`.
/// * The witness points are on the surfaces of the sets, up to 2^-50·S.
///
/// Any finite map is allowed. A map that is not rigid turns a sphere into an ellipsoid. Queries
/// with such maps take more time.
///
/// Method: GJK in double. If its bounds, with all rounding covered, differ by more than the
/// requested error, the search continues in double-double, from the simplex found. With the default
/// options this happens for nearly all sets closer than a hundredth of their size. For curved
/// surfaces, every second search direction comes from a Newton step. Cost: a mean of 2 to 5 rounds
/// in double for parts of few points (2 to 20 with a cylinder), 7 to 10 for polytopes of 100 to
/// 10^5 vertices, and less than 2 rounds in double-double. No test needed more than 100 rounds, at
/// gaps down to 10^-13; `tests/collision/convex/gjk_test.cpp` prints the numbers.
/// @param relative, absolute  allowed error, ≥ 0; `absolute` in metres. If both are 0, the accuracy
/// is the best that the guarantees above give.
/// @param cache  if not null, the cache of the same two sets (convex_cache.h).
ConvexDistance convexDistance(const PosedSet& a, const PosedSet& b, double relative = 0,
                              double absolute = 0, ConvexCache* cache = nullptr);

/// Computes the distance of two convex sets, in double-double. Use this function if
/// `convexSetsTouch` returns true although the sets are known to share no point (`confirmContact`,
/// exact_contact.h). The guarantees are those of `convexDistance`, and `distance` is above 0.
/// @param from  the cache that a query of the same two sets has filled.
/// @pre the sets share no point.
ConvexDistance separatedDistance(const PosedSet& a, const PosedSet& b, const ConvexCache& from);

/// A proved range of a distance, metres. If lower > 0, the sets do not touch.
struct ConvexRange {
  double lower = 0, upper = 0;
};
/// Computes a proved range of the distance of two convex sets, in double only.
///
/// The search stops as soon as the lower end of the range exceeds `beyond`, or the upper end is at
/// most `near`. If neither happens, both ends differ from the distance by at most the larger of
/// 2^-41·S (with the S of `convexDistance`) and 2^-20 of the distance. The range may be wider if
/// caps of cylinders face each other, or if the map of a sphere is not rigid.
/// @param beyond, near  metres.
ConvexRange convexDistanceRange(const PosedSet& a, const PosedSet& b, double beyond, double near);

}  // namespace corridor
