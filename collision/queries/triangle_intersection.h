#pragma once

#include "collision/core/transform.h"
#include "collision/predicates/triangle.h"

namespace corridor {

struct Segment {
  Vec3 p = Vec3::Zero(), q = Vec3::Zero();
};

/// The longest segment within what two triangles, each under its map, share: of triangles that
/// cross, all of it; of coplanar ones, between the two corners of their common polygon that are
/// farthest apart (a tie, or a difference below rounding, goes to either); a point: both ends
/// equal, bit for bit.
///
/// Each coordinate of an end is off the true one by at most 2^-50·S, S the largest Σ|m||v| + |t| of
/// the corners mapped. Double-double arithmetic where it proves that of itself, integers elsewhere.
/// @pre they touch (`trianglesTouch`); all numbers finite.
Segment triangleIntersection(const Triangle& a, const Transform& X_WA, const Triangle& b,
                             const Transform& X_WB);

/// The same by integers alone: ends are the true ones rounded to the nearest doubles.
Segment triangleIntersectionExact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                                  const Transform& X_WB);

}  // namespace corridor
