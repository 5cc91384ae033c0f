#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/volumes/obb.h"

namespace corridor {

/// A cluster of items: an item, or two earlier clusters merged.
struct Cluster {
  std::uint32_t left = 0, right = 0;  ///< its clusters; unused where it is an item
  std::uint32_t count = 1;            ///< of items
};

/// Agglomerative clustering of axis-aligned boxes: the first n clusters are the boxes, in order,
/// the last one is the root.
///
/// Parallel locally-ordered clustering (Meister, Bittner, IEEE TVCG 24(3), 2018), on one thread:
/// clusters are kept in Morton order; in every round each looks for the neighbour, at most
/// `kSearch` places away, with which it makes the box of least surface, and two that chose each
/// other merge. Few merges in a round (sizes in a geometric sequence, say) would make it
/// quadratic: then the rest is paired as it stands. O(n log n).
std::vector<Cluster> clustered(std::span<const Obb> boxes);

}  // namespace corridor
