#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// Returns the triangles of the convex hull of the points: indices, counterclockwise as seen from
/// outside. Exact: no point is outside any triangle's plane. Some vertices may be on an edge or
/// inside a face of the hull. The result is empty if all points are on one plane. The algorithm is
/// that of polytope.h.
/// @pre the points are finite, and there are at most 2^28 of them.
std::vector<std::array<std::uint32_t, 3>> quickhull(std::span<const Vec3> points);

}  // namespace corridor
