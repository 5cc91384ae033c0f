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
  std::string svg;  ///< at most some 100 KB
  std::size_t drawn =
      0;  ///< the number of volumes in the picture: the nearest, if some are left out
  std::size_t volumes = 0;  ///< the number of volumes on the level, with the leaves above it
  std::size_t levels = 0;   ///< the number of levels of the tree; the root is level 0
};

/// Draws a mesh, and the volumes of a level of its tree. If the tree has fewer levels, the picture
/// shows the last one.
/// @param trees the kind of tree. @pre `invalidNameIn(trees)` is nullopt.
/// @param from the direction of view; unset: from above, at an angle.
VolumePicture volumePicture(const TriangleMesh& mesh, const TreeNames& trees, std::size_t level,
                            const std::optional<ViewDirection>& from = {});

}  // namespace corridor
