#pragma once

#include <array>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "collision/predicates/triangle.h"

namespace corridor::test {

/// The oracle: the distance of two triangles under their maps that don't touch, with 100 digits,
/// by another method than the code under test: the least over corners against a whole triangle
/// (Voronoi regions) and edges against edges.
using Digits = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_100::backend_type,
                                             boost::multiprecision::et_off>;
Digits referenceDistance(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB);

/// Of a point and a triangle under its map.
Digits referenceDistance(const Vec3& p_W, const Triangle& t, const Transform& X_WT);

}  // namespace corridor::test
