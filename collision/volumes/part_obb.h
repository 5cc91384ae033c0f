#pragma once

#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// Returns a tight box around a convex part, rounded outward. The box contains the part in real
/// arithmetic. Capsules and cylinders get a box along their axis. Other parts get the smaller of
/// two boxes. The axes of the first box are along the edges at the part's first corner. If the part
/// is a box, the first box is tight, and the second box is not tried. The axes of the second box
/// are from the moments of the hull's surface.
Obb enclosingObb(const ConvexPart& part);

/// Returns solid spheres whose hull contains the part: spheres of its radius about its points. For
/// a cylinder, which has discs instead of spheres, returns spheres around the corners of its box;
/// their radius covers rounding.
std::vector<Ball> ballsOf(const ConvexPart& part);
/// Appends the spheres that `ballsOf` returns to `balls`.
void addBallsOf(const ConvexPart& part, std::vector<Ball>& balls);

}  // namespace corridor
