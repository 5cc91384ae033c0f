#pragma once

#include <optional>

#include "collision/queries/containment.h"
#include "collision/queries/distance.h"
#include "collision/queries/triangle_pair.h"
#include "collision/world/scene.h"

namespace corridor {

/// Queries of two bodies of any kind, each under its own map: surfaces of meshes, `solid` meshes
/// with everything that they enclose, and convex parts, which are solid and never tessellated.
///
/// With a convex part, sizes and coordinates must be within 2^±440 m, or 0. Beyond that the queries
/// may report bodies as closer than they are, or in contact, but never as farther apart.
///
/// The queries build the trees that they need, of the kind `trees`. Containment in a solid mesh
/// always uses the binary tree of boxes. They throw std::invalid_argument for maps that are not
/// finite, and for numbers that are not finite or negative. Threads may call them in parallel, with
/// one context per thread.

/// Returns a pair of triangles or convex parts that touch, or a triangle of a solid mesh and one of
/// the body inside it. Returns nothing if the bodies are separated. Exact for meshes; with a convex
/// part, in the band of `convexSetsTouch` the answer may be contact.
std::optional<TrianglePair> interference(const Body& a, const Transform& X_WA, const Body& b,
                                         const Transform& X_WB, QueryContext& context,
                                         TreeKind trees = TreeKind::obb4);

/// Returns the distance with a pair of witness points; the errors are those of queries/distance.h.
/// The distance is 0 if and only if `interference` reports contact. If one body is inside a solid
/// mesh, both witness points are the same point of the body inside.
Distance distance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                  const DistanceOptions& options, QueryContext& context,
                  TreeKind trees = TreeKind::obb4);

/// The tolerance query: reports whether the bodies are at most d metres apart. `false` is a proof
/// that they are farther apart.
bool closerThan(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                double d, QueryContext& context, TreeKind trees = TreeKind::obb4);

}  // namespace corridor
