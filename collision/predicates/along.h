#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// Returns the sign of n·(q − p), which is 1 if q is farther along n than p. Exact, in real
/// arithmetic on the given doubles: a filter in double decides most cases, and integers decide the
/// others.
/// @pre all numbers are finite.
int alongSign(const Vec3& n, const Vec3& p, const Vec3& q);

}  // namespace corridor
