#pragma once

#include <optional>

#include "collision/convex/point_columns.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// A convex set that contains a mesh: the hull of points, swept by a sphere. Each point is a vertex
/// of the mesh, or within `radius` of one.
struct EnclosingHull {
  PointColumns points;
  double radius = 0;  ///< metres; 0 if the points are vertices of the mesh
};

/// Returns a convex set of at most 1,024 points that contains all triangles of a mesh, or nothing
/// if such a set would not fit the mesh.
///
/// The points are the distinct vertices that the triangles use, if they are few enough. (Leaving
/// out those that are not vertices of the hull takes longer than building the mesh's tree:
/// measured.) Otherwise they are the centres of grid cells with vertices, and the sphere contains a
/// cell. A cell is left out if two other ones with vertices lie on both sides of it in a row of the
/// grid: the hull of these two contains it.
///
/// Whether the hull fits is a matter of time only: a hull that covers deep dents separates few
/// pairs. It fits if the triangles lie, on average over their area, less than 0.35 of the mesh's
/// radius below the hull's surface, in the directions of their outward normals. (A sample of 256
/// triangles is taken.) Walls of rooms do not fit, nor do meshes that are inside out.
/// @pre the mesh has a triangle, `checkMesh` reports nothing.
std::optional<EnclosingHull> enclosingHull(const TriangleMesh& mesh);

/// Returns a convex set that contains a hull of more than 200 points, with fewer points: the hull
/// of some of them, swept by a sphere that is larger by 1/1024 of the hull's radius. It takes about
/// 1 ms for 1,000 points, and makes each test of the hull a few times faster. Other hulls stay as
/// they are.
EnclosingHull thinned(EnclosingHull hull);

}  // namespace corridor
