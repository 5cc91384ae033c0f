#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/tree_kinds.h"
#include "planner/view/view_direction.h"

namespace corridor {

/// A picture of one level of a tree.
struct VolumePicture {
  std::string svg;  ///< at most some 200 KB
  /// The number of volumes in the picture. If some are left out, the nearest are drawn.
  std::size_t drawn = 0;
  /// The number of volumes on the level, including the leaves of the levels above.
  std::size_t volumes = 0;
  std::size_t levels = 0;  ///< the number of levels of the tree; the root is level 0
};

/// Draws a mesh, and the volumes of one level of its tree. If the tree has no such level, the
/// picture shows its last level.
/// @param trees the kind of tree. @pre All names in `trees` are valid: `invalidNameIn(trees)` is
/// nullopt.
/// @param from the direction of view; unset: from above, at an angle.
VolumePicture volumePicture(const TriangleMesh& mesh, const TreeNames& trees, std::size_t level,
                            const std::optional<ViewDirection>& from = {});

}  // namespace corridor
