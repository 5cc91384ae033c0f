#pragma once

#include <cstdint>
#include <vector>

#include "collision/hierarchy/tree_params.h"
#include "collision/hierarchy/tree_primitives.h"

namespace corridor {

/// A node before its volume is fitted: its leaf primitives, and a box around them. The volume is
/// then fitted in the coordinate frame of this box.
struct SkeletonNode {
  Obb box;
  std::uint32_t first = 0;  ///< its leaf primitives: [first, first + count)
  std::uint32_t count = 0;
  std::uint32_t right = 0;  ///< the right child; the left one follows the node. 0: a leaf
};
using Skeleton = std::vector<SkeletonNode>;  ///< depth first; the root is node 0

/// Builds a skeleton and puts the leaf primitives into leaf order. If `oriented` is true, each box
/// has the axes that `params.fit` gives for its content, otherwise the coordinate axes. The depth
/// of the tree is not limited, because the builder is not recursive.
Skeleton buildSkeleton(TreePrimitives& items, bool oriented, const TreeParams& params);

/// Returns the box with the given axes around the leaf primitives [first, first + count).
Obb framingBox(const TreePrimitives& items, std::uint32_t first, std::uint32_t count,
               const Mat3& axes);

}  // namespace corridor
