#pragma once

#include <optional>

#include "collision/core/query_context.h"
#include "collision/core/transform.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/hierarchy/octree.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// Returns the first pair found of leaf primitives of `a` under X_WA and `b` under X_WB that share
/// a point, or nullopt. Leaf primitives are closed triangles, or convex parts, which are solid. All
/// volumes and all builders give the same verdict.
///
/// For triangles the verdict is exact for the two maps with precisely the stored numbers, for any
/// finite maps (collision/PROMISES.md, promise 1). Near-rigid maps are fast, because only then
/// boxes prune. With a convex part, nullopt is always a proof, and a contact is right outside the
/// band of `convexSetsTouch`.
/// @pre The maps are finite (`Scene` throws on others).
/// @tparam Overlap  the overlap test of the boxes (overlap_obb_obb_variants.h), for example
/// `interference<Gjk>(a, …)` on ObbTrees. It changes only the time.
template <class Overlap = StandardOverlap, BoundingVolume Volume>
std::optional<TrianglePair> interference(const VolumeTree<Volume>& a, const Transform& X_WA,
                                         const VolumeTree<Volume>& b, const Transform& X_WB,
                                         QueryContext& context);

/// The same test, only below the first `count` entries of `context.stack4`. Only the node pairs
/// of these entries are used: their other fields are for 4-wide OBB trees. Gives up and returns
/// nullopt soon after the counted box and triangle tests reach `workEnd`.
template <class Overlap = StandardOverlap, BoundingVolume Volume>
std::optional<TrianglePair> interferenceBelow(const VolumeTree<Volume>& a, const Transform& X_WA,
                                              const VolumeTree<Volume>& b, const Transform& X_WB,
                                              std::size_t count, QueryContext& context,
                                              std::uint64_t workEnd = kNoWorkLimit);

/// The same test for two octrees (trees over space), and for an octree and a tree of AABBs (a tree
/// over triangles).
std::optional<TrianglePair> interference(const Octree& a, const Transform& X_WA, const Octree& b,
                                         const Transform& X_WB, QueryContext& context);
std::optional<TrianglePair> interference(const Octree& a, const Transform& X_WA,
                                         const VolumeTree<Aabb>& b, const Transform& X_WB,
                                         QueryContext& context);

}  // namespace corridor
