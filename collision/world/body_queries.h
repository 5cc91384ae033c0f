#pragma once

#include <optional>

#include "collision/queries/containment.h"
#include "collision/queries/distance.h"
#include "collision/queries/triangle_pair.h"
#include "collision/world/scene.h"

namespace corridor {

/// Queries of two bodies, whatever they are: surfaces of meshes, `solid` meshes with all that they
/// enclose, and primitives, solid and never tessellated; in all pairs, each under its own map.
///
/// With a primitive, sizes and coordinates are to be within 2^±440 m, or 0: beyond, bodies may be
/// called closer than they are, or in contact, never farther apart.
///
/// They build the trees that they need, of the kind `trees` (what is inside a solid mesh is asked
/// of the binary tree of boxes, whatever the kind), throw std::invalid_argument for maps that are
/// not finite and numbers that are not finite or negative, and may be called in parallel, with one
/// context a thread.

/// Do they share a point? The first pair found of triangles or parts that touch, or the triangle of
/// a solid around and one of what is inside; none where they are apart: exact for meshes, in the
/// band of `convexSetsTouch` where there is a primitive.
std::optional<TrianglePair> interference(const Body& a, const Transform& X_WA, const Body& b,
                                         const Transform& X_WB, QueryContext& context,
                                         TreeKind trees = TreeKind::wideObb);

/// How far are they apart, with points that have it (`queries/distance.h` has the errors)? 0 if and
/// only if `interference` says contact; of a body in a solid mesh both points are one of the
/// former.
Distance distance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                  const DistanceOptions& options, QueryContext& context,
                  TreeKind trees = TreeKind::wideObb);

/// The tolerance query: are they at most d metres apart? `false` is a proof that they are farther.
bool closerThan(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                double d, QueryContext& context, TreeKind trees = TreeKind::wideObb);

}  // namespace corridor
