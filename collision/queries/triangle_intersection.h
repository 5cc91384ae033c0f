#pragma once

#include "collision/core/transform.h"
#include "collision/predicates/triangle.h"

namespace corridor {

struct Segment {
  Vec3 p = Vec3::Zero(), q = Vec3::Zero();
};

/// Computes the longest segment within the intersection of two triangles, each under its map. For
/// triangles that cross, the segment is the whole intersection. For coplanar triangles it joins the
/// two corners of their common polygon that are farthest apart. If several pairs of corners are
/// equally far apart up to rounding, it joins any of these pairs. If the intersection is a single
/// point, both ends are equal, bit for bit.
///
/// Each coordinate of an end is off by at most 2^-50·S, where S is the largest Σ|m||v| + |t| of the
/// mapped corners. Double-double arithmetic is used where it can prove this bound, integers
/// elsewhere.
/// @pre The triangles touch (`trianglesTouch`); all numbers are finite.
Segment triangleIntersection(const Triangle& a, const Transform& X_WA, const Triangle& b,
                             const Transform& X_WB);

/// Computes the same segment by integers alone. The result is the exact segment with its ends
/// rounded to the nearest doubles.
Segment triangleIntersectionExact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                                  const Transform& X_WB);

}  // namespace corridor
