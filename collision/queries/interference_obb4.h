#pragma once

#include <concepts>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/core/last_pair.h"
#include "collision/core/posed.h"
#include "collision/core/query_context.h"
#include "collision/hierarchy/node_pair4.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/obb4_tree_pose.h"
#include "collision/queries/contacts.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// `interference` (interference.h) for 4-wide OBB trees: the same verdicts, several times faster.
/// Returns the first contact found, or nullopt. For triangles the verdict is exact for the twelve
/// doubles of each map in real arithmetic, for any finite maps. Queries are fast only if the maps
/// are nearly rigid. Convex parts are tested by `convexSetsTouch`, with its guarantee.
/// @pre The maps are finite.
///
/// Gives up and returns nullopt soon after the sum of the box tests and triangle tests that the
/// context has counted reaches `workEnd`.
///
/// Uses the best SIMD target of the machine, chosen at run time. Every target gives the same
/// verdict. All targets with fused multiply-add (all except SSE) give the same counts.
///
/// @param last  if not null, the pair of triangles that the last query of these trees found. If the
/// pair is likely to touch again (`LastPair::trusted`), it is tested first. The pair that this
/// query finds is stored there. `last` may change which touching pair is reported, and the counts,
/// but never the verdict. No pair of convex parts is tested first.
std::optional<PrimitivePair> interference(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                          QueryContext& context, LastPair* last = nullptr,
                                          std::uint64_t workEnd = kNoWorkLimit);

/// The same test, restricted to the subtrees of the node pairs `start`, and to the pair `last`.
std::optional<PrimitivePair> interferenceBelow(std::span<const NodePair4> start,
                                               const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                               QueryContext& context, LastPair* last = nullptr,
                                               std::uint64_t workEnd = kNoWorkLimit);

/// The same two functions with the template argument `Overlap`, for code that works on any kind of
/// trees (`withTrees`). 4-wide trees have only one overlap test.
template <std::same_as<StandardOverlap> Overlap>
std::optional<PrimitivePair> interference(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                          QueryContext& context, LastPair* last = nullptr) {
  return interference(a, b, context, last);
}
template <std::same_as<StandardOverlap> Overlap>
std::optional<PrimitivePair> interferenceBelow(std::span<const NodePair4> start,
                                               const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                               QueryContext& context, LastPair* last,
                                               std::uint64_t workEnd) {
  return interferenceBelow(start, a, b, context, last, workEnd);
}

/// The same test for queries that have already computed the relative pose of the trees. The result
/// has the numbers of the two leaf primitives in leaf order. @pre `!pose.apart`.
std::optional<PrimitivePair> touchingLeafTriangles(std::span<const NodePair4> start,
                                                   const Posed<Obb4Tree>& a,
                                                   const Posed<Obb4Tree>& b,
                                                   const Obb4TreePose& pose, QueryContext& context,
                                                   LastPair* last,
                                                   std::uint64_t workEnd = kNoWorkLimit);

/// `contacts` (contacts.h, with the same guarantees) for 4-wide OBB trees.
std::vector<TriangleContact> contacts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                      QueryContext& context);
template <std::same_as<StandardOverlap> Overlap>
std::vector<TriangleContact> contacts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                                      QueryContext& context) {
  return contacts(a, b, context);
}

}  // namespace corridor
