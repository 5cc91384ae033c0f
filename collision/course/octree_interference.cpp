#include "collision/course/octree_interference.h"

#include "collision/queries/first_contact.h"

namespace corridor {

std::optional<PrimitivePair> interference(const Posed<Octree>& a, const Posed<Octree>& b,
                                          QueryContext& context) {
  return firstContact<Aabb>(kWholeTrees, a, b, context);
}

std::optional<PrimitivePair> interference(const Posed<Octree>& a, const Posed<VolumeTree<Aabb>>& b,
                                          QueryContext& context) {
  return firstContact<Aabb>(kWholeTrees, a, b, context);
}

}  // namespace corridor
