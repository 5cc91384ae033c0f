#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// How far X_WA·(X_AB·p) may be from X_WB·p for |p| ≤ reach, brought back to frame A, metres: a
/// contact in W is, in A, a pair of points at most this far apart, so that boxes farther apart have
/// none. Infinite where X_WA is far from rigid.
double relativePoseError(const Transform& X_WA, const Transform& X_AB, const Transform& X_WB,
                         double reach);

}  // namespace corridor
