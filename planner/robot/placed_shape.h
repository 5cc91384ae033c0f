#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/rigid_pose.h"
#include "collision/geometry/convex_part.h"
#include "collision/geometry/mesh_file.h"
#include "planner/robot/note.h"

namespace corridor {

/// A shape in the coordinates of its link, or of the world. Scale, up-axis rotation, local pose,
/// and the translation to a rigid robot's reference point are already applied to its vertices or
/// points.
struct PlacedShape {
  std::string name;  ///< "table"; if a link has several shapes, "hand/2"
  /// Either `mesh` is set, or there are parts.
  /// With how the file was read; vertices in final coordinates. Shapes may share it: their bodies
  /// then share its trees.
  std::shared_ptr<const MeshFile> mesh;
  std::vector<ConvexPart> parts;       ///< one for a primitive; many for a point cloud or an octree
  std::filesystem::path file;          ///< of a mesh, a cloud or an octree
  std::optional<Primitive> primitive;  ///< of one part: as the user wrote it
  RigidPose at;                        ///< its pose as the user wrote it; in a URDF parts only
  bool solid = false;                  ///< mesh only; a part is always solid
  std::vector<Note> notes = {};        ///< about how the file was read
};

/// Calls visit(p, radius) for each vertex of the mesh, with radius 0, and for each point of the
/// parts, with the part's radius.
template <class Visit>
void forEachPoint(const PlacedShape& shape, const Visit& visit) {
  if (shape.mesh)
    for (const Vec3& p : shape.mesh->mesh.vertices) visit(p, 0.0);
  for (const ConvexPart& part : shape.parts)
    for (const Vec3& p : part.points) visit(p, part.radius);
}

}  // namespace corridor
