#include "collision/queries/interference.h"

#include "collision/queries/first_contact.h"

namespace corridor {

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

}  // namespace corridor
