#pragma once

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor::view {

/// Returns the surface of a convex part as a mesh, for pictures only. Its vertices are the part's
/// farthest points in directions spread over a sphere, joined like these directions.
TriangleMesh tessellated(const ConvexPart& part);

/// Returns a coarser mesh, for pictures in which triangles would be smaller than a pixel: in each
/// cell of a grid of size `cell`, the first vertex stands for all.
TriangleMesh coarsened(const TriangleMesh& mesh, double cell);

}  // namespace corridor::view
