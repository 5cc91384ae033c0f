#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/volumes/obb.h"

namespace corridor {

/// A cluster: one leaf primitive, or two earlier clusters merged.
struct Cluster {
  std::uint32_t left = 0, right = 0;  ///< the clusters that it merges; unused for a leaf primitive
  std::uint32_t count = 1;            ///< number of leaf primitives
};

/// Returns an agglomerative clustering of axis-aligned boxes: the first n clusters are the boxes,
/// in order, and the last one is the root.
///
/// The method is parallel locally-ordered clustering (Meister, Bittner, IEEE TVCG 24(3), 2018), on
/// one thread. Clusters are kept in Morton order. In every round each cluster finds the neighbour,
/// at most `kSearch` places away, with which it makes the box of least surface. Two clusters that
/// chose each other merge. Rounds with few merges (sizes in a geometric sequence, say) would make
/// it quadratic. Then neighbours are paired as they stand. The cost is O(n log n).
std::vector<Cluster> clustered(std::span<const Obb> boxes);

}  // namespace corridor
