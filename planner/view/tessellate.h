#pragma once

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor::view {

/// The surface of a convex part, for pictures only: its farthest points in directions that are
/// spread over a sphere, joined as the directions are.
TriangleMesh tessellated(const ConvexPart& part);

}  // namespace corridor::view
