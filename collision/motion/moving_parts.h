#pragma once

#include "collision/core/counters.h"
#include "collision/geometry/convex_part.h"
#include "collision/motion/motion_window.h"
#include "collision/motion/moving_triangles.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// As `decideMovingTriangles`, for two convex solids a (at rest) and b (moves as the window says).
/// `contact`: at the rounded pose of the middle the two are within 2^-44 of the largest coordinate
/// of each other, or within the margin.
MovingTrianglesAnswer decideMovingParts(const ConvexPart& a, const ConvexPart& b,
                                        const MotionWindow& window, double margin,
                                        Counters& counters);
/// The same with a triangle (a closed surface patch, no solid) on one side.
MovingTrianglesAnswer decideMovingParts(const Triangle& a, const ConvexPart& b,
                                        const MotionWindow& window, double margin,
                                        Counters& counters);
MovingTrianglesAnswer decideMovingParts(const ConvexPart& a, const Triangle& b,
                                        const MotionWindow& window, double margin,
                                        Counters& counters);

}  // namespace corridor
