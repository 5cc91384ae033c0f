#pragma once

#include "collision/geometry/convex_part.h"
#include "collision/motion/moving_triangles.h"
#include "collision/motion/relative_motion.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// Decides a pair of convex parts in a time interval, with the method of `decideMovingTriangles`. a
/// is at rest; b moves by the relative motion `relative`. `contact` means that, at the rounded pose
/// at the middle, the parts are closer than 2^-44 times the largest coordinate, or are proved to be
/// within the margin.
MovingPairAnswer decideMovingParts(const ConvexPart& a, const ConvexPart& b,
                                   const RelativeMotion& relative, double margin);
/// The same decision for a triangle and a convex part. The triangle is a closed patch of surface,
/// not a solid.
MovingPairAnswer decideMovingParts(const Triangle& a, const ConvexPart& b,
                                   const RelativeMotion& relative, double margin);
MovingPairAnswer decideMovingParts(const ConvexPart& a, const Triangle& b,
                                   const RelativeMotion& relative, double margin);

}  // namespace corridor
