#pragma once

#include <array>
#include <cstdint>

#include "collision/core/transform.h"

namespace corridor {

/// The GJK simplex that the last query of two convex sets ended with. If the sets move in small
/// steps, the next query takes fewer rounds when it begins with this simplex. The caller owns the
/// cache; an empty cache means a cold start. The cache changes no verdict, and no distance beyond
/// its error bound.
///
/// A cache belongs to one pair of sets: the points of both sets must be the same in each query. The
/// next query begins with the first three corners.
struct ConvexCache {
  struct Corner {
    std::uint32_t pointA = 0, pointB = 0;  ///< indices of the sets' points
    Vec3 n = Vec3::Zero();                 ///< from a to b: both points were extreme along it
  };
  std::array<Corner, 4> corner;  ///< four corners: the sets overlap
  int count = 0;
  int rounds = 0;  ///< rounds of GJK that the last query took
};

}  // namespace corridor
