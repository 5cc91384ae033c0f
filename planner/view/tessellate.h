#pragma once

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "planner/robot/placed_shape.h"

namespace corridor::view {

/// Returns the surface of a convex part as a mesh, for pictures only. Each vertex is the part's
/// farthest point in one of many directions. The directions form a grid on a sphere, and vertices
/// of neighbouring directions are joined to triangles.
TriangleMesh tessellated(const ConvexPart& part);
/// Returns the surfaces of many parts as one mesh. In long lists, round parts are coarse: balls
/// become octahedra. If there are more than `kMostParts` parts, the mesh has only some of them,
/// evenly spread over the list.
TriangleMesh tessellated(const std::vector<ConvexPart>& parts);
constexpr std::size_t kMostParts = 20'000;
/// Returns the exact surface of flat convex parts, such as the pieces of a polygon, as triangles
/// that are visible from both sides. @pre The corners of each part are in order.
TriangleMesh flatSurface(const std::vector<ConvexPart>& pieces);

/// Returns the surface of the convex parts of a shape that has no mesh: by `flatSurface` for a
/// polygon, otherwise by `tessellated`.
TriangleMesh partsSurface(const PlacedShape& shape);

/// Returns a coarser mesh, for pictures in which triangles would be smaller than a pixel. In each
/// cell of a grid with cells of edge length `cell`, the first vertex replaces the other vertices in
/// the cell.
TriangleMesh coarsened(const TriangleMesh& mesh, double cell);

}  // namespace corridor::view
