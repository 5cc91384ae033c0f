#pragma once

#include "collision/predicates/triangle.h"

namespace corridor::test {

/// The oracle: do two triangles under their maps share a point, in rationals, by another method
/// than the code under test (a common point as a convex combination of either triangle: linear
/// programming)?
bool rationalContact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                     const Transform& X_WB);

}  // namespace corridor::test
