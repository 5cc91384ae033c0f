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
  std::size_t volumes = 0;  ///< on the level, with the leaves of the levels above
  std::size_t levels = 0;   ///< of the tree; the root is level 0
};

/// Draws a mesh, and the volumes of a level of its tree. Without such a level, the picture has the
/// last one.
/// @param trees the tree; `invalidNameIn` reports nothing.
/// @param from the direction of view; unset: from above, at an angle.
VolumePicture volumePicture(const TriangleMesh& mesh, const TreeNames& trees, std::size_t level,
                            const std::optional<ViewDirection>& from = {});

}  // namespace corridor
