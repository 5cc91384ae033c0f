#pragma once

#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// Returns a tight box around a convex part, rounded outward: it contains the part in real
/// arithmetic. Capsules and cylinders get a box along their axis. Other parts get the smaller of
/// two boxes. The first has its axes along the edges at the first corner; if the part is a box,
/// this box is exact, and the second one is not tried. The second has its axes from the moments of
/// the hull's surface.
Obb enclosingObb(const ConvexPart& part);

/// Returns solid spheres whose hull contains the part: spheres of its radius about its points. A
/// cylinder has discs instead of spheres, so it gets the corners of its box.
std::vector<Ball> ballsOf(const ConvexPart& part);
/// Appends these spheres to `balls`.
void addBallsOf(const ConvexPart& part, std::vector<Ball>& balls);

}  // namespace corridor
