#pragma once

#include <optional>

#include "collision/convex/point_columns.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// Returns the distinct vertices that the triangles of a mesh use, if they are at most 800 and
/// their hull fits the mesh; else nullopt. (Of more vertices, some would have to be left out.
/// Finding those takes longer than building the mesh's tree: measured.)
///
/// Whether the hull fits is a matter of time only: a hull that covers deep dents separates few
/// pairs. It fits if the triangles lie, on average over their area, less than 0.35 of the mesh's
/// radius below the hull's surface, in the directions of their outward normals. (A sample of 256
/// triangles is taken.) Walls of rooms do not fit, nor do meshes that are inside out.
/// @pre the mesh has a triangle, `checkMesh` reports nothing.
std::optional<PointColumns> enclosingHull(const TriangleMesh& mesh);

}  // namespace corridor
