#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/volumes/obb.h"

namespace corridor {

/// A cluster: one leaf primitive, or the union of two earlier clusters.
struct Cluster {
  std::uint32_t left = 0, right = 0;  ///< the two merged clusters; unused for a leaf primitive
  std::uint32_t count = 1;            ///< number of leaf primitives
};

/// Returns an agglomerative clustering of axis-aligned boxes. The first n clusters are the n boxes,
/// in order, and the last cluster is the root.
///
/// The method is parallel locally-ordered clustering (Meister, Bittner, IEEE TVCG 24(3), 2018), on
/// one thread. Clusters are kept in Morton order. In every round each cluster chooses a neighbour
/// at most `kSearch` (cluster.cpp) places away: the neighbour with which it makes the box of least
/// surface. Two clusters that chose each other merge.
///
/// If a round has few merges, as for boxes whose sizes are a geometric sequence, adjacent clusters
/// are merged in pairs instead. The cost is therefore O(n log n); without this rule it could be
/// quadratic.
std::vector<Cluster> clustered(std::span<const Obb> boxes);

}  // namespace corridor
