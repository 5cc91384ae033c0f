#pragma once

#include "collision/hierarchy/body.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/queries/distance.h"

namespace corridor {

/// `distance` and `closerThan` (distance.h, with the same guarantees) for two bodies: for the
/// surfaces of meshes, and for convex parts, which are solid. They don't test whether a `solid`
/// mesh has the other body inside; `world/body_queries.h` does. They build the trees that they
/// need.
/// @param trees  the kind of trees. Distance queries bound distances of volumes and never test
/// overlap, so the kinds that differ in their overlap tests are equivalent. A convex part has no
/// 4-wide tree for distances: a binary tree of OBBs replaces it.
Distance surfaceDistance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                         const DistanceOptions& options, QueryContext& context,
                         TreeKind trees = TreeKind::obb4);
bool surfacesCloserThan(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                        double d, QueryContext& context, TreeKind trees = TreeKind::obb4);

/// Returns a proved lower bound of the surfaces' distance in real arithmetic, metres; 0 if nothing
/// can be proved, or if they touch.
///
/// For meshes the bound is the distance in `told` minus its guaranteed error. For convex parts, for
/// which the lower and upper bound of the search nearly always agree, the tolerance query proves
/// the bound again.
/// @param told  the result of `surfaceDistance` for the same bodies and maps, with these options.
/// @pre The maps are within 2^-20 of rotations.
double provedDistance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                      const Distance& told, const DistanceOptions& options, QueryContext& context,
                      TreeKind trees = TreeKind::obb4);

/// Returns an upper bound of the surfaces' distance, metres. `told` as above.
double distanceFromAbove(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                         const Distance& told);

}  // namespace corridor
