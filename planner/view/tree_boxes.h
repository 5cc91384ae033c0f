#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/hierarchy/obb4_tree.h"

namespace corridor::view {

/// The boxes of an OBB tree, level by level, for pictures. Each box is ten floats: its centre
/// relative to the `origin` given to `treeBoxes`, its rotation as a quaternion x, y, z, w, and its
/// half extents. They are in metres, in the frame of the tree's body. The boxes contain the shape
/// only up to the rounding to float.
struct TreeBoxes {
  std::vector<float> numbers;        ///< ten for each box, from level 0 (the root) on
  std::vector<std::uint8_t> leaves;  ///< for each box: 1: it contains primitives; 0: boxes
  /// The number of boxes of each level; a leaf counts only on its own level.
  std::vector<std::size_t> counts;
};

/// Returns the first levels of a tree, from the root down: as many levels as have, together, at
/// most `most` boxes.
TreeBoxes treeBoxes(const Obb4Tree& tree, const Vec3& origin, std::size_t most);

}  // namespace corridor::view
