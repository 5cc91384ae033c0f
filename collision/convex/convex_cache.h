#pragma once

#include <array>
#include <cstdint>

#include "collision/core/transform.h"

namespace corridor {

/// What the last query of two convex sets has found: the GJK simplex that it ended with. If the
/// sets move in small steps, the next query that begins with it takes fewer rounds. The caller owns
/// it; empty means cold. It changes no verdict, and no distance beyond its error bound.
///
/// A cache belongs to one pair of sets: their points must be the same in each query. The next query
/// begins with the first three corners.
struct ConvexCache {
  struct Corner {
    std::uint32_t pointA = 0, pointB = 0;  ///< indices of the sets' points
    Vec3 n = Vec3::Zero();                 ///< the direction along which they were extreme
  };
  std::array<Corner, 4> corner;  ///< four: the sets overlap
  int count = 0;
  int rounds = 0;  ///< rounds of GJK that the last query took
};

}  // namespace corridor
