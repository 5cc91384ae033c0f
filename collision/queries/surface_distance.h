#pragma once

#include "collision/core/last_pair.h"
#include "collision/core/posed.h"
#include "collision/hierarchy/body.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/queries/distance.h"

namespace corridor {

/// `distance` and `closerThan` (distance.h, with the same guarantees) for two bodies: for the
/// surfaces of meshes, and for convex parts, which are solid. Neither function tests whether a body
/// is inside a `solid` mesh; the functions in `world/body_queries.h` do. Both build the trees that
/// they need.
/// @param trees the kind of trees. Distance queries bound distances of volumes and never test
/// overlap. So kinds that differ only in their overlap tests are equivalent.
/// @param last  as for `distance` and `closerThan` of 4-wide OBB trees; other trees don't use it.
Distance surfaceDistance(const Posed<Body>& a, const Posed<Body>& b, const DistanceOptions& options,
                         QueryContext& context, TreeKind trees = TreeKind::obb4,
                         LastPair* last = nullptr);
bool surfacesCloserThan(const Posed<Body>& a, const Posed<Body>& b, double d, QueryContext& context,
                        TreeKind trees = TreeKind::obb4, LastPair* last = nullptr);

/// Returns a proved lower bound of the surfaces' distance in real arithmetic, metres; 0 if nothing
/// can be proved, or if they touch.
///
/// For meshes the bound is the distance in `measured` minus its guaranteed error. For convex parts,
/// the tolerance query then proves the same bound again; if it cannot, the result is 0.
/// @param measured  the result of `surfaceDistance` for the same bodies and maps, with these
/// options.
/// @pre The maps are within 2^-20 of rotations.
double distanceLowerBound(const Posed<Body>& a, const Posed<Body>& b, const Distance& measured,
                          const DistanceOptions& options, QueryContext& context,
                          TreeKind trees = TreeKind::obb4);

/// Returns an upper bound of the surfaces' distance, metres. `measured` is as for
/// `distanceLowerBound`.
double distanceUpperBound(const Posed<Body>& a, const Posed<Body>& b, const Distance& measured);

}  // namespace corridor
