#pragma once

#include "collision/hierarchy/volume_tree.h"
#include "collision/motion/descend.h"

namespace corridor {

/// `descend` (descend.h) for binary trees of any volume: the certified edge as one reads of it,
/// beside the fast one. For a pair of nodes in a window of time:
///
/// 1. At the window's middle the two volumes are tested with a pad: what is asked for (margin), and
///    how far b's volume goes in the window, *whatever the direction*, tube and rounding included.
///    Apart: all below the two are, for all of the window.
/// 2. Else whatever is coarser is split: time, where b's volume goes far for the size of the larger
///    one: the pair is left to the window's halves; …
/// 3. … or space: the larger volume is opened (`traverse`).
/// 4. Two leaves: their triangles or parts decide, along the direction of their closest points, as
///    in every other method (`decideMovingTriangles`, `decideMovingParts`).
///
/// The wide trees' `descend` knows more of boxes: how far they go along the very axis that they are
/// tested along. So it opens fewer; the answers are the same.
///
/// Of the items of `context.wideStack` and `later` only the pairs of nodes matter.
/// @param Overlap how two volumes are tested (overlap_obb_obb_variants.h).
template <class Overlap, BoundingVolume Volume>
Descent descend(const VolumeTree<Volume>& a, const VolumeTree<Volume>& b,
                const MotionWindow& window, const DescentOptions& options, std::size_t count,
                std::vector<QueryContext::WideItem>& later, QueryContext& context);

}  // namespace corridor
