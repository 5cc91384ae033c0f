#pragma once

#include "collision/predicates/triangle.h"

namespace corridor {

/// Two points, one of each triangle, that are closest to each other, and their distance in metres.
struct WitnessPoints {
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
  double distance = 0;
  double error = 0;  ///< upper bound of the error of `distance`, metres
};

/// Computes the closest points of two triangles under their maps, in double-double, with a power of
/// two near their size as unit. The result is precise enough to be reported.
///
/// The distance is off by less than u·(S/4 + 2·distance), where S is the largest Σ|m||v| + |t| of
/// the mapped corners and u = 2^-53. The points are rounded to doubles and off by less than u·S per
/// coordinate. For crossing triangles the computed distance is as small as rounding errors, but
/// need not be exactly 0.
WitnessPoints witnessPoints(const Triangle& a, const Transform& X_WA, const Triangle& b,
                            const Transform& X_WB);

/// A proved range of a distance, metres: lower ≤ distance ≤ upper, and both are at least 0.
struct DistanceRange {
  double lower = 0, upper = 0;
};

/// Bounds the distance of two triangles under two maps, in double. The upper bound is the distance
/// of the closest points of their features. The lower bound is the gap between the triangles'
/// projections onto the line through these points. Both bounds include the rounding.
class TriangleDistances {
 public:
  /// @param reachA, reachB  metres: each triangle lies within this distance of its frame's origin.
  TriangleDistances(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB);
  DistanceRange operator()(const Triangle& a, const Triangle& b) const;

 private:
  Transform X_WA_, X_WB_;
  double unit_, error_;
};

}  // namespace corridor
