#include "collision/queries/interference.h"

#include "collision/hierarchy/traverse.h"
#include "collision/queries/touching_pairs.h"

namespace corridor {
namespace {

/// Finds the first contact below the node pairs in `context.stack`.
template <class Volume, class Overlap = StandardOverlap, class TreeA, class TreeB>
std::optional<TrianglePair> firstContactBelow(const TreeA& a, const Transform& X_WA, const TreeB& b,
                                              const Transform& X_WB, QueryContext& context,
                                              std::uint64_t workEnd = kNoWorkLimit) {
  ++context.counters.states;
  const auto test = pairTestOf<Volume, Overlap>(a, X_WA, b, X_WB);
  std::optional<TrianglePair> found;
  const auto first = [&](std::uint32_t s, std::uint32_t t) {
    found = TrianglePair{a.meshTriangle(s), b.meshTriangle(t)};
    return true;
  };
  TouchingPairs query(a, X_WA, b, X_WB, test, context.counters, first, workEnd);
  traverseFrom(a, b, context.stack, query);
  return found;
}

template <class Volume, class Overlap = StandardOverlap, class TreeA, class TreeB>
std::optional<TrianglePair> firstContact(const TreeA& a, const Transform& X_WA, const TreeB& b,
                                         const Transform& X_WB, QueryContext& context) {
  context.stack.assign(1, {0, 0, 0});
  return firstContactBelow<Volume, Overlap>(a, X_WA, b, X_WB, context);
}

}  // namespace

template <class Overlap, BoundingVolume Volume>
std::optional<TrianglePair> interference(const VolumeTree<Volume>& a, const Transform& X_WA,
                                         const VolumeTree<Volume>& b, const Transform& X_WB,
                                         QueryContext& context) {
  return firstContact<Volume, Overlap>(a, X_WA, b, X_WB, context);
}

template <class Overlap, BoundingVolume Volume>
std::optional<TrianglePair> interferenceBelow(const VolumeTree<Volume>& a, const Transform& X_WA,
                                              const VolumeTree<Volume>& b, const Transform& X_WB,
                                              std::size_t count, QueryContext& context,
                                              std::uint64_t workEnd) {
  context.stackFrom(count);
  return firstContactBelow<Volume, Overlap>(a, X_WA, b, X_WB, context, workEnd);
}

#define CORRIDOR_INTERFERENCE(Volume, Overlap)                                                  \
  template std::optional<TrianglePair> interference<Overlap>(                                   \
      const VolumeTree<Volume>&, const Transform&, const VolumeTree<Volume>&, const Transform&, \
      QueryContext&);                                                                           \
  template std::optional<TrianglePair> interferenceBelow<Overlap>(                              \
      const VolumeTree<Volume>&, const Transform&, const VolumeTree<Volume>&, const Transform&, \
      std::size_t, QueryContext&, std::uint64_t);
CORRIDOR_EACH_OVERLAP(CORRIDOR_INTERFERENCE)
#undef CORRIDOR_INTERFERENCE

std::optional<TrianglePair> interference(const Octree& a, const Transform& X_WA, const Octree& b,
                                         const Transform& X_WB, QueryContext& context) {
  return firstContact<Aabb>(a, X_WA, b, X_WB, context);
}

std::optional<TrianglePair> interference(const Octree& a, const Transform& X_WA,
                                         const VolumeTree<Aabb>& b, const Transform& X_WB,
                                         QueryContext& context) {
  return firstContact<Aabb>(a, X_WA, b, X_WB, context);
}

}  // namespace corridor
