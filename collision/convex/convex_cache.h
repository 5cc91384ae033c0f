#pragma once

#include <array>
#include <cstdint>

#include "collision/core/transform.h"

namespace corridor {

/// The GJK simplex with which the previous query of two convex sets ended. If the sets move in
/// small steps, the next query takes fewer rounds when it begins with this simplex. The caller owns
/// the cache; an empty cache means a cold start. The cache changes no verdict, and changes no
/// distance by more than the error bound of the distance.
///
/// A cache belongs to one pair of sets: the points of both sets must be the same in each query. The
/// next query uses at most the first three corners.
struct ConvexCache {
  struct Corner {
    std::uint32_t pointA = 0, pointB = 0;  ///< indices of the sets' points
    Vec3 n = Vec3::Zero();  ///< from a to b: `pointA` was extreme along n, `pointB` along −n
  };
  /// The first `count` corners are valid. If all four are valid, the sets overlapped.
  std::array<Corner, 4> corner;
  int count = 0;
  int rounds = 0;  ///< rounds of GJK that the previous query took
};

}  // namespace corridor
