#pragma once

#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// Returns a tight box around a convex part, rounded outward: it contains the part in real
/// arithmetic. Capsules and cylinders get a box along their axis. Other point sets get the smaller
/// of two: along the edges at the first corner (a box's own axes, then), or by the moments of the
/// hull's surface.
Obb enclosingObb(const ConvexPart& part);

/// Returns solid spheres whose hull contains the part: its points with its radius. The discs of a
/// cylinder are no spheres, so a cylinder gets the corners of its box.
std::vector<Ball> ballsOf(const ConvexPart& part);

}  // namespace corridor
