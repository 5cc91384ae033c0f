#pragma once

#include <cstdint>
#include <vector>

#include "collision/hierarchy/tree_items.h"
#include "collision/hierarchy/tree_params.h"

namespace corridor {

/// A tree before it has volumes: which items each node holds, and the box that frames them.
struct SkeletonNode {
  Obb box;
  std::uint32_t first = 0;  ///< its items: [first, first + count)
  std::uint32_t count = 0;
  std::uint32_t right = 0;  ///< the right child; the left one follows the node. 0: a leaf
};
using Skeleton = std::vector<SkeletonNode>;  ///< depth first; the root is node 0

/// Builds a skeleton and puts the items into leaf order. `oriented`: the boxes have the axes of
/// their content's moments, else those of the mesh. Any depth: no call stack is used.
Skeleton buildSkeleton(TreeItems& items, bool oriented, const TreeParams& params);

/// The box that frames the items [first, first + count), with the axes given.
Obb framingBox(const TreeItems& items, std::uint32_t first, std::uint32_t count, const Mat3& axes);

}  // namespace corridor
