#include "collision/queries/contacts.h"

#include "collision/hierarchy/traverse.h"
#include "collision/queries/touching_pairs.h"
#include "collision/queries/triangle_intersection.h"

namespace corridor {
template <class Overlap, BoundingVolume Volume>
std::vector<TriangleContact> contacts(const VolumeTree<Volume>& a, const Transform& X_WA,
                                      const VolumeTree<Volume>& b, const Transform& X_WB,
                                      QueryContext& context) {
  ++context.counters.states;
  const auto test = pairTestOf<Volume, Overlap>(a, X_WA, b, X_WB);
  std::vector<TriangleContact> all;
  const auto add = [&](std::uint32_t s, std::uint32_t t) {
    const Segment segment = triangleIntersection(a.triangles()[s], X_WA, b.triangles()[t], X_WB);
    all.push_back({a.meshTriangle(s), b.meshTriangle(t), segment.p, segment.q});
    return false;
  };
  TouchingPairs query(a, X_WA, b, X_WB, test, context.counters, add);
  traverse(a, b, QueryContext::NodePair{0, 0, 0}, context.stack, query);
  return all;
}

#define CORRIDOR_CONTACTS(Volume, Overlap)                                                      \
  template std::vector<TriangleContact> contacts<Overlap>(                                      \
      const VolumeTree<Volume>&, const Transform&, const VolumeTree<Volume>&, const Transform&, \
      QueryContext&);
CORRIDOR_EACH_OVERLAP(CORRIDOR_CONTACTS)
#undef CORRIDOR_CONTACTS

}  // namespace corridor
