#pragma once

#include <optional>
#include <span>

#include "collision/core/last_pair.h"
#include "collision/core/posed.h"
#include "collision/core/query_context.h"
#include "collision/hierarchy/node_pair4.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// Returns the first pair found of two leaf primitives, one of each tree, that share a point, or
/// nullopt if there is none. Leaf primitives are closed triangles, or convex parts, which are
/// solid. All volumes and all builders give the same verdict.
///
/// For triangles the verdict is exact for the two maps with precisely the stored numbers, for any
/// finite maps (collision/PROMISES.md, promise 1). Queries are fast only if the maps are nearly
/// rigid: otherwise the boxes separate nothing. With a convex part, nullopt is always a proof;
/// contact may be reported for gaps within the band of `convexSetsTouch` (glossary in
/// collision/README.md).
/// @pre The maps are finite (`Scene` throws on others).
/// @param last  if not null, the pair of triangles that the last query of these trees found. If the
/// pair is likely to touch again (`LastPair::trusted`), it is tested first. The pair that this
/// query finds is stored there. `last` may change which touching pair is reported, and the counts,
/// but never the verdict. No pair of convex parts is tested first.
/// @tparam Overlap  the overlap test of the boxes (overlap_obb_obb_variants.h), for example
/// `interference<Gjk>(a, …)` on ObbTrees. It changes only the time.
template <class Overlap = StandardOverlap, BoundingVolume Volume>
std::optional<PrimitivePair> interference(const Posed<VolumeTree<Volume>>& a,
                                          const Posed<VolumeTree<Volume>>& b, QueryContext& context,
                                          LastPair* last = nullptr);

/// The same test, restricted to the subtrees of the node pairs `start`, and to the pair `last`.
/// Gives up and returns nullopt soon after the counted box and triangle tests reach `workEnd`.
template <class Overlap = StandardOverlap, BoundingVolume Volume>
std::optional<PrimitivePair> interferenceBelow(std::span<const NodePair4> start,
                                               const Posed<VolumeTree<Volume>>& a,
                                               const Posed<VolumeTree<Volume>>& b,
                                               QueryContext& context, LastPair* last = nullptr,
                                               std::uint64_t workEnd = kNoWorkLimit);

}  // namespace corridor
