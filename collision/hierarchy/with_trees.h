#pragma once

#include "collision/hierarchy/body.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {

/// Calls `f.operator()<Volume, Overlap>()` for a kind of binary trees. The call turns the kind into
/// types, once per query. @pre `trees` is not `TreeKind::obb4`.
template <class F>
decltype(auto) withVolume(TreeKind trees, const F& f) {
  switch (trees) {
#define CORRIDOR_CASE(kind, Volume, Overlap, volumeName, overlapName) \
  case TreeKind::kind:                                                \
    return f.template operator()<Volume, Overlap>();
    CORRIDOR_EACH_OVERLAP(CORRIDOR_CASE)
#undef CORRIDOR_CASE
    case TreeKind::obb4:
      break;
  }
  return f.template operator()<Obb, StandardOverlap>();
}

/// Calls `query(Overlap{}, tree of a, tree of b)` with the trees of two bodies, of the given kind.
/// Trees are built if necessary.
template <class Query>
decltype(auto) withTrees(TreeKind trees, const Body& a, const Body& b, const Query& query) {
  if (trees == TreeKind::obb4) return query(StandardOverlap{}, a.tree(), b.tree());
  return withVolume(trees, [&]<class Volume, class Overlap>() {
    return query(Overlap{}, a.volumeTree<Volume>(), b.volumeTree<Volume>());
  });
}

}  // namespace corridor
