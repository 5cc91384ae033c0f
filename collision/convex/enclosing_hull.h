#pragma once

#include <optional>

#include "collision/convex/convex_set.h"
#include "collision/convex/point_columns.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// A convex set that contains a mesh: the hull of some of its vertices, swept by a sphere of radius
/// `radius`, metres.
struct EnclosingHull {
  PointColumns points;
  double radius = 0;

  ConvexSet set() const { return ConvexSet(points, radius); }
};

/// Returns an enclosing hull of a mesh if one fits it, or else nullopt. Of up to 400 vertices, all
/// are its points, and the radius is 0. Of more vertices, those are chosen that are farthest in one
/// of 192 directions, and those that are farther than a thousandth of the mesh's radius from the
/// hull of these, up to 400 points. The radius of the sphere is the largest distance of another
/// vertex from the hull, rounded up. A mesh of more than 4,096 vertices has none: building it would
/// take longer than building a tree.
///
/// Whether the hull fits is a matter of time only: a hull that covers deep dents separates few
/// pairs. It fits if the triangles lie, on average over their area, less than 0.35 of the mesh's
/// radius below the hull's surface, in the directions of their outward normals. (A sample of 256
/// triangles is taken.) Walls of rooms do not fit, nor do meshes that are inside out.
/// @pre the mesh has a triangle, `checkMesh` reports nothing.
std::optional<EnclosingHull> enclosingHull(const TriangleMesh& mesh);

}  // namespace corridor
