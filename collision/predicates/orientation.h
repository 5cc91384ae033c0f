#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// A point under a map; the map must stay.
struct MappedPoint {
  const Transform& X;
  Vec3 p;
};

/// Sign of det(q − p, r − p, s − p) in real arithmetic on the doubles given: on which side of the
/// plane through p, q, r is s? A filter in double first, integers where it can't tell.
/// @pre all numbers finite.
int orientationSign(const MappedPoint& p, const MappedPoint& q, const MappedPoint& r,
                    const MappedPoint& s);

}  // namespace corridor
