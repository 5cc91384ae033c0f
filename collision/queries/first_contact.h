#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "collision/core/last_pair.h"
#include "collision/core/posed.h"
#include "collision/core/query_context.h"
#include "collision/hierarchy/node_pair4.h"
#include "collision/hierarchy/traverse.h"
#include "collision/queries/touching_pairs.h"
#include "collision/queries/triangle_pair.h"

/// Internal: the traversal of `interference`, for any two trees with a test of their volumes.
namespace corridor {

/// Finds the first contact in the subtrees of the node pairs `start`.
template <class Volume, class Overlap = StandardOverlap, class TreeA, class TreeB>
std::optional<PrimitivePair> firstContact(std::span<const NodePair4> start, const Posed<TreeA>& a,
                                          const Posed<TreeB>& b, QueryContext& context,
                                          LastPair* last = nullptr,
                                          std::uint64_t workEnd = kNoWorkLimit) {
  const auto test = pairTestOf<Volume, Overlap>(a, b);
  std::optional<PrimitivePair> found;  // numbered in leaf order
  const auto first = [&](std::uint32_t s, std::uint32_t t) {
    found = PrimitivePair{s, t};
    return true;
  };
  TouchingPairs query(a, b, test, context.counters, first, workEnd);
  const bool known =
      last && last->trusted() && last->isIn(a.shape.triangles().size(), b.shape.triangles().size());
  if (known) {
    if (query.touch(last->a, last->b)) found = PrimitivePair{last->a, last->b};
    last->recordTest(found.has_value());
  }
  if (!found) {
    const auto use = context.scratch.use<NodePairs>();
    NodePairs& stack = *use;
    fillStack(start, stack);
    traverseFrom(a.shape, b.shape, stack, query);
    if (found && last) last->recordFound(found->a, found->b);
  }
  if (!found) return found;
  return PrimitivePair{a.shape.meshTriangle(found->a), b.shape.meshTriangle(found->b)};
}

}  // namespace corridor
