#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/core/transform.h"
#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/hierarchy/wide_pose.h"
#include "collision/queries/contacts.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// `interference` (interference.h) for wide trees: the same verdicts, several times faster. First
/// contact found, or none; solids as `convexSetsTouch` says, exact for the twelve doubles of each
/// map in real arithmetic, for any finite maps; near-rigid ones are fast. @pre finite maps.
///
/// The pair that touched last, as the context remembers, is tested first: what came before changes
/// which touching pair is named, and the counts, never the verdict.
///
/// Gives up, as if nothing touched, soon after the counted box and triangle tests reach `workEnd`.
///
/// SIMD by run-time dispatch; every target gives the same verdict, and all that multiply and add at
/// once (all but SSE) the same counts.
std::optional<TrianglePair> interference(const WideObbTree& a, const Transform& X_WA,
                                         const WideObbTree& b, const Transform& X_WB,
                                         QueryContext& context,
                                         std::uint64_t workEnd = kNoWorkLimit);

/// The same of what is below the first `count` items of `context.wideStack` only (and of the pair
/// that touched last).
std::optional<TrianglePair> interferenceBelow(const WideObbTree& a, const Transform& X_WA,
                                              const WideObbTree& b, const Transform& X_WB,
                                              std::size_t count, QueryContext& context,
                                              std::uint64_t workEnd = kNoWorkLimit);

/// The same by triangles in leaf order, for queries that have the pose. @pre not `pose.apart`.
std::optional<TrianglePair> touchingLeafTriangles(const WideObbTree& a, const Transform& X_WA,
                                                  const WideObbTree& b, const Transform& X_WB,
                                                  const WidePose& pose, QueryContext& context,
                                                  std::uint64_t workEnd = kNoWorkLimit);

/// `contacts` (contacts.h, with its promises) for wide trees. Allocates what it returns.
std::vector<TriangleContact> contacts(const WideObbTree& a, const Transform& X_WA,
                                      const WideObbTree& b, const Transform& X_WB,
                                      QueryContext& context);

}  // namespace corridor
