#pragma once

#include "collision/predicates/triangle.h"

namespace corridor {

/// Points of two triangles that are closest to each other, and their distance, metres.
struct WitnessPoints {
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
  double distance = 0;
  double error = 0;  ///< the most that it may be off by
};

/// Of two triangles under their maps, in double-double on a power-of-two unit of their size: for
/// results. The distance is off by less than u·(S/4 + 2·distance), S the largest Σ|m||v| + |t| of
/// the corners mapped; the points, rounded to doubles, by u·S a coordinate. Crossing triangles have
/// distances of rounding size.
WitnessPoints closestPoints(const Triangle& a, const Transform& X_WA, const Triangle& b,
                            const Transform& X_WB);

/// The distance lies in [lower, upper], proved; 0 and above.
struct DistanceRange {
  double lower = 0, upper = 0;
};

/// Bounds distances of triangles under two maps, in double: the closest points of their features
/// bound from above, projections onto the line between these from below.
class TriangleDistances {
 public:
  /// For triangles within `reachA`, `reachB` of their frames' origins.
  TriangleDistances(const Transform& X_WA, double reachA, const Transform& X_WB, double reachB);
  DistanceRange operator()(const Triangle& a, const Triangle& b) const;

 private:
  Transform X_WA_, X_WB_;
  double unit_, error_;
};

}  // namespace corridor
