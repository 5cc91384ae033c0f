#pragma once

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "planner/robot/placed_shape.h"

namespace corridor::view {

/// Returns the surface of a convex part as a mesh, for pictures only. Each vertex is the part's
/// farthest point in one of many directions. The directions form a grid on a sphere, and the
/// vertices are joined like neighbours in this grid.
TriangleMesh tessellated(const ConvexPart& part);
/// Returns the surfaces of many parts. Round parts of long lists are coarse: balls become
/// octahedra. If there are more than `kMostParts`, only some are shown, evenly spread over the
/// list.
TriangleMesh tessellated(const std::vector<ConvexPart>& parts);
constexpr std::size_t kMostParts = 20'000;
/// Returns the exact surface of flat convex parts, such as the pieces of a polygon, as triangles
/// that are seen from both sides. @pre each part has its corners in order.
TriangleMesh flatSurface(const std::vector<ConvexPart>& pieces);

/// Returns the surface of a shape that has no mesh: `flatSurface` for the pieces of a polygon,
/// `tessellated` for other parts.
TriangleMesh partsSurface(const PlacedShape& shape);

/// Returns a coarser mesh, for pictures in which triangles would be smaller than a pixel: in each
/// cell of a grid of size `cell`, the first vertex replaces all others.
TriangleMesh coarsened(const TriangleMesh& mesh, double cell);

}  // namespace corridor::view
