#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/core/transform.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/obb4_tree_pose.h"
#include "collision/queries/contacts.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// `interference` (interference.h) for 4-wide OBB trees: the same verdicts, several times faster.
/// Returns the first contact found, or nullopt. For triangles it is exact for the twelve doubles of
/// each map in real arithmetic, for any finite maps; near-rigid maps are fast. Convex parts are
/// tested by `convexSetsTouch`, with its guarantee.
/// @pre The maps are finite.
///
/// The pair that touched last, which the context remembers, is tested first. Earlier queries may
/// change which touching pair is reported, and the counts, but never the verdict.
///
/// Gives up and returns nullopt soon after the counted box and triangle tests reach `workEnd`.
///
/// SIMD by run-time dispatch. Every target gives the same verdict. All targets with fused
/// multiply-add (all except SSE) give the same counts.
std::optional<TrianglePair> interference(const Obb4Tree& a, const Transform& X_WA,
                                         const Obb4Tree& b, const Transform& X_WB,
                                         QueryContext& context,
                                         std::uint64_t workEnd = kNoWorkLimit);

/// The same test, only below the first `count` entries of `context.stack4`, and on the pair that
/// touched last.
std::optional<TrianglePair> interferenceBelow(const Obb4Tree& a, const Transform& X_WA,
                                              const Obb4Tree& b, const Transform& X_WB,
                                              std::size_t count, QueryContext& context,
                                              std::uint64_t workEnd = kNoWorkLimit);

/// The same test for queries that have already computed the pose. The result numbers triangles in
/// leaf order. @pre `!pose.apart`.
std::optional<TrianglePair> touchingLeafTriangles(const Obb4Tree& a, const Transform& X_WA,
                                                  const Obb4Tree& b, const Transform& X_WB,
                                                  const Obb4TreePose& pose, QueryContext& context,
                                                  std::uint64_t workEnd = kNoWorkLimit);

/// `contacts` (contacts.h, with the same guarantees) for 4-wide OBB trees. Allocates what it
/// returns.
std::vector<TriangleContact> contacts(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b,
                                      const Transform& X_WB, QueryContext& context);

}  // namespace corridor
