#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "collision/core/rigid_pose.h"
#include "collision/geometry/convex_part.h"
#include "collision/geometry/mesh_file.h"

namespace corridor {

/// A shape in the coordinates of its link, or of the world. Scale, up-axis rotation, local pose,
/// and the translation to a rigid robot's reference point are already applied to its vertices or
/// points.
struct PlacedShape {
  std::string name;  ///< "table"; if a link has several shapes, "hand/2"
  /// Exactly one of `mesh` and `part` is set.
  std::optional<MeshFile> mesh;  ///< with how the file was read; vertices in final coordinates
  std::optional<ConvexPart> part;
  std::filesystem::path file;          ///< mesh only
  std::optional<Primitive> primitive;  ///< part only: as the user wrote it
  RigidPose at;                        ///< part only: its pose as the user wrote it
  bool solid = false;                  ///< mesh only; a part is always solid
};

}  // namespace corridor
