#pragma once

#include "collision/predicates/triangle.h"

namespace corridor {

/// Points of two triangles that are closest to each other as far as features go: of all pairs of
/// edges and of corner and face. Where the triangles don't cross, these are the closest points, up
/// to rounding; where they do, it says nothing. Never a proof by itself: a caller verifies what he
/// takes from it (a direction, say) by projections. Source: Ericson, Real-Time Collision Detection,
/// 2005, sections 5.1.5 and 5.1.9.
struct ClosestPoints {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double squaredDistance = 0;
  /// Whose they are: 3·i + k for edges i of a and k of b (from that corner to the next), 9 + k for
  /// b's corner k over a's face, 12 + i for a's corner i over b's.
  int feature = 0;
};
ClosestPoints closestFeaturePoints(const Triangle& a, const Triangle& b);

}  // namespace corridor
