#pragma once

#include <optional>
#include <vector>

#include "collision/core/last_pair.h"
#include "collision/core/posed.h"
#include "collision/queries/contacts.h"
#include "collision/queries/containment.h"
#include "collision/queries/distance.h"
#include "collision/queries/triangle_pair.h"
#include "collision/world/scene.h"

namespace corridor {

/// Queries of two bodies of any kind, each under its own map: surfaces of meshes, `solid` meshes
/// (with everything that the mesh encloses), and convex parts, which are solid and never
/// tessellated.
///
/// With a convex part, sizes and the magnitudes of coordinates must be from 2^-440 to 2^440 m, or
/// 0. Beyond that range the queries may report bodies as closer than they are, or in contact, but
/// never as farther apart than they are.
///
/// The queries build the trees that they need, of the kind `trees`. Tests of containment in a solid
/// mesh always use the binary tree of boxes. Queries throw std::invalid_argument for maps that are
/// not finite, and for distances and errors that are negative or not finite. (Only
/// `DistanceOptions::upTo` may be infinite.) Threads may call them in parallel, with one context
/// per thread.
///
/// `last`, if not null, is a guess: the pair that the previous query of the same two bodies with
/// the same kind of trees found. Queries may test this pair first (core/last_pair.h), and store the
/// pair that they find. If bodies move in small steps, the guess saves a tenth to two thirds of the
/// time (hierarchy/MEASURED.md). With convex parts the guess has no effect. The guess never changes
/// a verdict, nor a distance beyond the distance's error bound.

/// Returns a pair of triangles or convex parts that touch, or a triangle of a solid mesh together
/// with a triangle or convex part of the body inside it. Returns nullopt if the bodies are
/// separated. Exact for meshes. With a convex part, contact may also be reported for gaps below
/// 2^-44 of the largest coordinate (`convexSetsTouch`).
std::optional<PrimitivePair> interference(const Posed<Body>& a, const Posed<Body>& b,
                                          QueryContext& context, TreeKind trees = TreeKind::obb4,
                                          LastPair* last = nullptr);

/// Returns all pairs of triangles of two meshes that touch, each with the segment that they share
/// (queries/contacts.h).
/// @throws std::invalid_argument for a convex part, which has no triangles.
std::vector<TriangleContact> contacts(const Posed<Body>& a, const Posed<Body>& b,
                                      QueryContext& context, TreeKind trees = TreeKind::obb4);

/// Returns the distance with a pair of witness points. Errors are those of `distance` in
/// queries/distance.h. The distance is 0 if and only if `interference` reports contact. If one body
/// is inside a solid mesh and touches none of its triangles, both witness points are the same point
/// of the inner body.
Distance distance(const Posed<Body>& a, const Posed<Body>& b, const DistanceOptions& options,
                  QueryContext& context, TreeKind trees = TreeKind::obb4, LastPair* last = nullptr);

/// The tolerance query: reports whether the bodies are at most d metres apart. `false` is a proof
/// that they are farther apart than d. `true` may be wrong only in the two cases that `closerThan`
/// in queries/distance.h states.
bool closerThan(const Posed<Body>& a, const Posed<Body>& b, double d, QueryContext& context,
                TreeKind trees = TreeKind::obb4, LastPair* last = nullptr);

}  // namespace corridor
