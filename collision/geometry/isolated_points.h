#pragma once

#include <span>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// Returns, for each point, whether fewer than `neighbours` other points are at most `distance`
/// away. Points of a cloud that a sensor measured wrongly are mostly isolated (radius outlier
/// removal). Distances are rounded.
///
/// Method: the points are put into the cells of a grid, and 27 cells are searched for each point
/// until enough neighbours are found. O(n log n) for clouds of similar density.
/// @param distance metres.
/// @throws std::invalid_argument if the distance is not finite or not above 0, or below 2^-52 of a
/// coordinate. @pre the points are finite.
std::vector<bool> isolatedPoints(std::span<const Vec3> points, double distance,
                                 std::size_t neighbours);

}  // namespace corridor
