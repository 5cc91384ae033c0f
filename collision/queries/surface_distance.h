#pragma once

#include "collision/hierarchy/body.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/queries/distance.h"

namespace corridor {

/// `distance` and `closerThan` (distance.h, with their promises) of two bodies: of the surfaces of
/// meshes, and of primitives, which are solid. Nobody looks whether a mesh that is `solid` has the
/// other body inside: `world/body_queries.h` does. They build the trees that they need.
/// @param trees  which. They are asked how far apart volumes are, not whether they overlap: the
/// tests of overlap make no difference. A primitive has no wide tree for distances: a binary one of
/// boxes stands for it.
Distance surfaceDistance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                         const DistanceOptions& options, QueryContext& context,
                         TreeKind trees = TreeKind::wideObb);
bool surfacesCloserThan(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                        double d, QueryContext& context, TreeKind trees = TreeKind::wideObb);

/// What may be built on: at least this far are the surfaces apart, in real arithmetic, metres. 0
/// where nothing can be proved, or they touch.
///
/// Of meshes it is `told` less its promised error. Of primitives, whose search ends at bounds that
/// nearly always meet, the tolerance query proves it again.
/// @param told by `surfaceDistance` of the same, with these options.
/// @pre maps within 2^-20 of rotations.
double provedDistance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                      const Distance& told, const DistanceOptions& options, QueryContext& context,
                      TreeKind trees = TreeKind::wideObb);

/// The other side of it: they are at most this far apart, metres.
double distanceFromAbove(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                         const Distance& told);

}  // namespace corridor
