#pragma once

#include "collision/predicates/triangle.h"

namespace corridor::test {

/// The oracle: returns the distance of two triangles under their maps that don't touch, correct to
/// a unit in the last place (two units for subnormals). It uses another method than the code under
/// test: the least squared distance of corners from a whole triangle (Voronoi regions) and of edges
/// from edges, as fractions of integers.
double referenceDistance(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB);

/// The same for a point and a triangle under its map.
double referenceDistance(const Vec3& p_W, const Triangle& t, const Transform& X_WT);

}  // namespace corridor::test
