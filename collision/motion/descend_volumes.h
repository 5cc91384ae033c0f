#pragma once

#include "collision/hierarchy/volume_tree.h"
#include "collision/motion/descend.h"

namespace corridor {

/// `descend` (descend.h) for binary trees of any volume: the certified edge in its plainest form,
/// beside the fast one. For a node pair in a time interval:
///
/// 1. At the interval's middle the two volumes are tested with a pad: the margin, plus the motion
///    bound of b's volume *in any direction*, tube and rounding included. If they are separated,
///    everything below them is, in all of the interval.
/// 2. Otherwise the coarser of time and space is split. Time, if b's volume moves far for the size
///    of the larger volume: the node pair is left to the interval's halves.
/// 3. Else space: the larger volume is opened (`traverse`).
/// 4. For two leaves, their triangles or convex parts decide, along the direction of their closest
///    points, as in every other method (`decideMovingTriangles`, `decideMovingParts`).
///
/// `descend` on 4-wide OBB trees has motion bounds for boxes along the very axis tested, and
/// therefore opens fewer nodes. The answers are the same.
///
/// Only the nodes of the items of `start` and `later` have a meaning.
/// @tparam Overlap  how two volumes are tested (overlap_obb_obb_variants.h).
template <class Overlap, BoundingVolume Volume>
Descent descend(std::span<const NodePair4> start, const VolumeTree<Volume>& a,
                const VolumeTree<Volume>& b, const RelativeMotion& relative,
                const DescentOptions& options, std::vector<NodePair4>& later,
                QueryContext& context);

}  // namespace corridor
