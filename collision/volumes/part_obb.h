#pragma once

#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// A tight box around a convex part, rounded outward: contains it in real arithmetic. Along the
/// axis of a capsule or a cylinder; along the edges at its first corner, or by the moments of the
/// hull's surface, whichever is smaller, around other points (a box's own axes, then).
Obb enclosingObb(const ConvexPart& part);

/// Balls whose hull holds the part: its points with its radius; of a cylinder, whose discs no ball
/// fits, the corners of its box.
std::vector<Ball> ballsOf(const ConvexPart& part);

}  // namespace corridor
