#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/mesh_file.h"
#include "collision/motion/rigid_motion.h"

namespace corridor {

/// A shape in the coordinates of its link (or of the world): scale, up-axis turn, local pose and
/// the shift to a rigid robot's reference point are already in its vertices or points.
struct PlacedShape {
  std::string name;  ///< "table"; of a link with several: "hand/2"
  /// Exactly one of the two.
  std::optional<MeshFile> mesh;  ///< format and rules; its `mesh` is the final one
  std::optional<ConvexPart> part;
  std::filesystem::path file;          ///< of a mesh
  std::optional<Primitive> primitive;  ///< of a part: as it was written
  RigidPose at;                        ///< of a part: as it was written
  bool solid = false;                  ///< of a mesh; parts always are
};

}  // namespace corridor
