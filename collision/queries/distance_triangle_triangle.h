#pragma once

#include "collision/predicates/triangle.h"

namespace corridor {

/// The closest points over all pairs of features of two triangles: two edges, or a corner and a
/// face. If the triangles don't cross, these are their closest points up to rounding; if they
/// cross, the result means nothing. The result alone is never a proof. A caller that uses, for
/// example, the direction between the points to separate the triangles must verify the separation
/// by projections. Source: Ericson, Real-Time Collision Detection, 2005, sections 5.1.5 and 5.1.9.
struct ClosestPoints {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double squaredDistance = 0;
  /// The pair of features that the points belong to: 3·i + k for edge i of a and edge k of b (an
  /// edge goes from the corner of the same number to the next corner), 9 + k for b's corner k over
  /// a's face, 12 + i for a's corner i over b's face.
  int feature = 0;
};
ClosestPoints closestFeaturePoints(const Triangle& a, const Triangle& b);

}  // namespace corridor
