#pragma once

#include "collision/predicates/triangle.h"

namespace corridor::test {

/// The oracle: the distance of two triangles under their maps that don't touch, correct to a unit
/// in the last place (twice that in subnormals), by another method than the code under test: the
/// least over corners against a whole triangle (Voronoi regions) and edges against edges, squared,
/// as fractions of integers.
double referenceDistance(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB);

/// Of a point and a triangle under its map.
double referenceDistance(const Vec3& p_W, const Triangle& t, const Transform& X_WT);

}  // namespace corridor::test
