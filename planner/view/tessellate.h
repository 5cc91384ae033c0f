#pragma once

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor::view {

/// The surface of a convex part, for pictures only: its farthest points in directions that are
/// spread over a sphere, joined as the directions are.
TriangleMesh tessellated(const ConvexPart& part);

/// The mesh with vertices closer than `cell` taken together, for pictures in which its triangles
/// would be smaller than a pixel: the first vertex met in each cell of a grid stands for all.
TriangleMesh coarsened(const TriangleMesh& mesh, double cell);

}  // namespace corridor::view
