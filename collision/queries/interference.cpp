#include "collision/queries/interference.h"

#include "collision/hierarchy/traverse.h"
#include "collision/queries/touching_pairs.h"

namespace corridor {
namespace {

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
    auto& stack = context.scratch.of<NodePairs>();
    fillStack(start, stack);
    traverseFrom(a.shape, b.shape, stack, query);
    if (found && last) last->recordFound(found->a, found->b);
  }
  if (!found) return found;
  return PrimitivePair{a.shape.meshTriangle(found->a), b.shape.meshTriangle(found->b)};
}

}  // namespace

template <class Overlap, BoundingVolume Volume>
std::optional<PrimitivePair> interference(const Posed<VolumeTree<Volume>>& a,
                                          const Posed<VolumeTree<Volume>>& b, QueryContext& context,
                                          LastPair* last) {
  return firstContact<Volume, Overlap>(kWholeTrees, a, b, context, last);
}

template <class Overlap, BoundingVolume Volume>
std::optional<PrimitivePair> interferenceBelow(std::span<const NodePair4> start,
                                               const Posed<VolumeTree<Volume>>& a,
                                               const Posed<VolumeTree<Volume>>& b,
                                               QueryContext& context, LastPair* last,
                                               std::uint64_t workEnd) {
  return firstContact<Volume, Overlap>(start, a, b, context, last, workEnd);
}

#define CORRIDOR_INTERFERENCE(kind, Volume, Overlap, volumeName, overlapName)                   \
  template std::optional<PrimitivePair> interference<Overlap>(const Posed<VolumeTree<Volume>>&, \
                                                              const Posed<VolumeTree<Volume>>&, \
                                                              QueryContext&, LastPair*);        \
  template std::optional<PrimitivePair> interferenceBelow<Overlap>(                             \
      std::span<const NodePair4>, const Posed<VolumeTree<Volume>>&,                             \
      const Posed<VolumeTree<Volume>>&, QueryContext&, LastPair*, std::uint64_t);
CORRIDOR_EACH_OVERLAP(CORRIDOR_INTERFERENCE)
#undef CORRIDOR_INTERFERENCE

std::optional<PrimitivePair> interference(const Posed<Octree>& a, const Posed<Octree>& b,
                                          QueryContext& context) {
  return firstContact<Aabb>(kWholeTrees, a, b, context);
}

std::optional<PrimitivePair> interference(const Posed<Octree>& a, const Posed<VolumeTree<Aabb>>& b,
                                          QueryContext& context) {
  return firstContact<Aabb>(kWholeTrees, a, b, context);
}

}  // namespace corridor
