#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// Returns an upper bound of the distance between X_WA·(X_AB·p) and X_WB·p for |p| ≤ reach,
/// measured in frame A; metres. If a point of a and a point of b coincide in W, X_AB maps the
/// point of b to at most this distance from the point of a. So the contents of boxes that are
/// farther apart in A do not touch. The bound is infinite if X_WA is far from rigid.
double relativePoseError(const Transform& X_WA, const Transform& X_AB, const Transform& X_WB,
                         double reach);

}  // namespace corridor
