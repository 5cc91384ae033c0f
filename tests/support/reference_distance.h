#pragma once

#include "collision/predicates/triangle.h"

namespace corridor::test {

/// The oracle: returns the distance of two triangles, each under its map, correct to a unit in the
/// last place (two units for subnormals). The method differs from that of the code under test. It
/// computes in fractions of integers. The result is the square root of the least of these squared
/// distances: that of each corner from the other triangle (by Voronoi regions), and that of each
/// edge from each edge of the other triangle.
double referenceDistance(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB);

/// Returns the distance of a point in world coordinates from a triangle under its map, with the
/// same accuracy.
double referenceDistance(const Vec3& p_W, const Triangle& t, const Transform& X_WT);

}  // namespace corridor::test
