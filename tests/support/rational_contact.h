#pragma once

#include "collision/predicates/triangle.h"

namespace corridor::test {

/// The oracle: returns whether two triangles under their maps share a point, in rational
/// arithmetic. The method differs from that of the code under test: a linear program that looks for
/// a point that is a convex combination of the corners of a, and also of the corners of b.
bool rationalContact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                     const Transform& X_WB);

}  // namespace corridor::test
