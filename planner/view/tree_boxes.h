#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/hierarchy/obb4_tree.h"

namespace corridor::view {

/// The boxes of a tree, level by level, for pictures. Each box is ten floats: the centre relative
/// to `origin`, a quaternion x, y, z, w, and the half extents; metres, in the body's frame. The
/// boxes contain the shape only up to the rounding to float.
struct TreeBoxes {
  std::vector<float> numbers;        ///< level 0 (the root) first
  std::vector<std::uint8_t> leaves;  ///< 1: the box contains leaf primitives, not boxes
  std::vector<std::size_t> counts;   ///< boxes per level; a leaf is counted on its own level only
};

/// Returns the first levels, from the root down: as many as have at most `most` boxes together.
TreeBoxes treeBoxes(const Obb4Tree& tree, const Vec3& origin, std::size_t most);

}  // namespace corridor::view
