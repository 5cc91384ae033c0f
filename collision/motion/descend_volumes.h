#pragma once

#include "collision/hierarchy/volume_tree.h"
#include "collision/motion/descend.h"

namespace corridor {

/// `descend` (descend.h) for binary trees of any volume: the simplest form of the method. The fast
/// form is in descend.cpp. The steps for a node pair in a time interval:
///
/// 1. At the interval's middle the two volumes are tested with a pad: the margin, plus the motion
///    bound of b's volume *in any direction*, with tube and rounding. If they are separated,
///    everything below them is separated in all of the interval.
/// 2. Otherwise time is split if b's volume moves far, compared to the size of the larger volume.
///    The node pair is then left to the interval's halves.
/// 3. Otherwise space is split: the larger volume is opened (`traverse`).
/// 4. Two leaves are decided by their triangles or convex parts, along the direction of the closest
///    points (`decideMovingTriangles`, `decideMovingParts`).
///
/// `descend` on 4-wide OBB trees has a motion bound along each tested axis, and therefore opens
/// fewer nodes. The verdicts are the same.
///
/// Only the members `a` and `b` of the items of `start` and `later` are used.
/// @tparam Overlap  how two volumes are tested (overlap_obb_obb_variants.h).
template <class Overlap, BoundingVolume Volume>
Descent descend(std::span<const NodePair4> start, const VolumeTree<Volume>& a,
                const VolumeTree<Volume>& b, const RelativeMotion& relative,
                const DescentOptions& options, std::vector<NodePair4>& later,
                QueryContext& context);

}  // namespace corridor
