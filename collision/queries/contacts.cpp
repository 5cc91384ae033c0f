#include "collision/queries/contacts.h"

#include <stdexcept>

#include "collision/hierarchy/traverse.h"
#include "collision/queries/touching_pairs.h"
#include "collision/queries/triangle_intersection.h"

namespace corridor {
template <class Overlap, BoundingVolume Volume>
std::vector<TriangleContact> contacts(const Posed<VolumeTree<Volume>>& a,
                                      const Posed<VolumeTree<Volume>>& b, QueryContext& context) {
  if (!a.X_W.isFinite() || !b.X_W.isFinite())
    throw std::invalid_argument("contacts: the maps must be finite");
  const auto test = pairTestOf<Volume, Overlap>(a, b);
  std::vector<TriangleContact> all;
  const auto add = [&](std::uint32_t s, std::uint32_t t) {
    const Segment segment =
        triangleIntersection(a.shape.triangle(s), a.X_W, b.shape.triangle(t), b.X_W);
    all.push_back({a.shape.meshTriangle(s), b.shape.meshTriangle(t), segment.p, segment.q});
    return false;
  };
  TouchingPairs query(a, b, test, context.counters, add);
  traverse(a.shape, b.shape, NodePair{0, 0}, *context.scratch.use<NodePairs>(), query);
  return all;
}

#define CORRIDOR_CONTACTS(kind, Volume, Overlap, volumeName, overlapName) \
  template std::vector<TriangleContact> contacts<Overlap>(                \
      const Posed<VolumeTree<Volume>>&, const Posed<VolumeTree<Volume>>&, QueryContext&);
CORRIDOR_EACH_OVERLAP(CORRIDOR_CONTACTS)
#undef CORRIDOR_CONTACTS

}  // namespace corridor
