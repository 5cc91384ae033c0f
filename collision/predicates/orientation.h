#pragma once

#include "collision/core/transform.h"

namespace corridor {

using Vec2 = Eigen::Vector2d;

/// A point under an affine map. Holds a reference to the map: the map must outlive the
/// `MappedPoint`.
struct MappedPoint {
  const Transform& X;
  Vec3 p;
};

/// Returns the sign of det(q − p, r − p, s − p), which is the side of the plane through p, q and r
/// on which s lies. Exact, in real arithmetic on the given doubles: a filter in double decides most
/// cases, and integers decide the others.
/// @pre all numbers are finite.
int orientationSign(const MappedPoint& p, const MappedPoint& q, const MappedPoint& r,
                    const MappedPoint& s);

/// A vector: the difference of two mapped points.
struct MappedEdge {
  MappedPoint from, to;
};

/// Returns the sign of det(u, v, w) for three vectors. Exact, like `orientationSign`, but always
/// computed in integers. Callers that have their own filter use this function.
int exactDeterminantSign(const MappedEdge& u, const MappedEdge& v, const MappedEdge& w);

/// Returns the same sign as `orientationSign` for points under the identity map, but is faster.
/// @pre all numbers are finite.
int planeSide(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s);

/// Returns 1 if r is left of the line from p to q in the plane, −1 if it is right of the line, 0 if
/// it is on the line. Exact.
/// @pre all coordinates are finite.
int lineSide(const Vec2& p, const Vec2& q, const Vec2& r);

}  // namespace corridor
