#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/convex/convex_polygon.h"
#include "collision/core/rigid_pose.h"
#include "collision/geometry/convex_part.h"
#include "collision/geometry/mesh_file.h"
#include "planner/robot/note.h"

namespace corridor {

/// A shape in the coordinates of its body's frame: the frame of a link, the world, or an obstacle's
/// own frame. Scale, up-axis rotation, local pose, and the translation to a rigid robot's reference
/// point are already applied to its vertices or points.
struct PlacedShape {
  std::string name;  ///< "table"; if a link has several shapes, "hand/2"
  /// The mesh, with the facts about how its file was read; null for a shape of parts. Several
  /// shapes may share a mesh; their bodies then share the mesh's trees.
  std::shared_ptr<const MeshFile> mesh;
  std::vector<ConvexPart> parts;  ///< one for a primitive; many for a cloud, an octree, a polygon
  std::filesystem::path file;     ///< the file that was read for this shape, if any
  std::optional<Primitive> primitive;  ///< as the user wrote it; nullopt: no primitive
  RigidPose at;        ///< the primitive's pose, as the user gave it; `parts` has it applied
  bool solid = false;  ///< mesh only; a part is always solid
  std::vector<Note> notes = {};  ///< about how the file was read
  /// The corners of a planar polygon, in the plane z = 0 of the frame; empty for other shapes. The
  /// parts are its convex pieces.
  std::vector<Vec2> polygon = {};
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
