#pragma once

#include <optional>

#include "collision/core/query_context.h"
#include "collision/core/transform.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/hierarchy/octree.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// Do closed triangles of a (or its convex parts, solids) under X_WA and of b under X_WB share a
/// point? The first pair found, or none. Any volume and any way of building give the same verdict.
///
/// Exact for the twelve doubles of each map in real arithmetic (design: contract 1), for any finite
/// maps; near-rigid ones are fast, since only then the boxes prune. With a convex part: never
/// falsely none, and right outside the band of `convexSetsTouch`. @pre finite maps (`Scene` throws
/// on others).
///
/// `Overlap`: how boxes are tested (overlap_obb_obb_variants.h): `interference<Gjk>(a, …)` of
/// ObbTrees; only the time differs.
template <class Overlap = StandardOverlap, BoundingVolume Volume>
std::optional<TrianglePair> interference(const VolumeTree<Volume>& a, const Transform& X_WA,
                                         const VolumeTree<Volume>& b, const Transform& X_WB,
                                         QueryContext& context);

/// The same of what is below the first `count` items of `context.wideStack` only (pairs of nodes:
/// what else is in them is of wide trees). Gives up, as if nothing touched, soon after the counted
/// box and triangle tests reach `workEnd`.
template <class Overlap = StandardOverlap, BoundingVolume Volume>
std::optional<TrianglePair> interferenceBelow(const VolumeTree<Volume>& a, const Transform& X_WA,
                                              const VolumeTree<Volume>& b, const Transform& X_WB,
                                              std::size_t count, QueryContext& context,
                                              std::uint64_t workEnd = kNoWorkLimit);

/// The same for trees over space, and for one over space and one over objects.
std::optional<TrianglePair> interference(const Octree& a, const Transform& X_WA, const Octree& b,
                                         const Transform& X_WB, QueryContext& context);
std::optional<TrianglePair> interference(const Octree& a, const Transform& X_WA,
                                         const VolumeTree<Aabb>& b, const Transform& X_WB,
                                         QueryContext& context);

}  // namespace corridor
