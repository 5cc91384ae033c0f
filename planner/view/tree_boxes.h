#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/hierarchy/wide_obb_tree.h"

namespace corridor::view {

/// The boxes of a tree, level by level, as ten floats each: the centre from `origin`, a quaternion
/// x, y, z, w, and the half extents; metres, in the body's frame. For pictures: float's rounding is
/// in them.
struct TreeBoxes {
  std::vector<float> numbers;        ///< of level 0 (the root) first
  std::vector<std::uint8_t> leaves;  ///< 1: the box holds triangles (or a solid), not boxes
  std::vector<std::size_t> counts;   ///< boxes of each level; leaves are on their own level only
};

/// Levels from the root on, as long as there are any and all of them have at most `most` boxes.
TreeBoxes treeBoxes(const WideObbTree& tree, const Vec3& origin, std::size_t most);

}  // namespace corridor::view
