#pragma once

#include "collision/hierarchy/body.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {

/// Calls `f.operator()<Volume, Overlap>()` for a kind of binary trees. This turns the kind into a
/// type, once per query. @pre not `TreeKind::obb4`.
template <class F>
decltype(auto) withVolume(TreeKind trees, const F& f) {
  switch (trees) {
    case TreeKind::obb4:
    case TreeKind::obbBinary:
      break;
    case TreeKind::obbGjk:
      return f.template operator()<Obb, Gjk>();
    case TreeKind::obbLinearProgram:
      return f.template operator()<Obb, LinearProgram>();
    case TreeKind::obbEdgeFace:
      return f.template operator()<Obb, EdgeFace>();
    case TreeKind::aabb:
      return f.template operator()<Aabb, StandardOverlap>();
    case TreeKind::sphere:
      return f.template operator()<BoundingSphere, StandardOverlap>();
    case TreeKind::rss:
      return f.template operator()<Rss, StandardOverlap>();
    case TreeKind::kdop14:
      return f.template operator()<Kdop<14>, StandardOverlap>();
    case TreeKind::kdop18:
      return f.template operator()<Kdop<18>, StandardOverlap>();
    case TreeKind::kdop26:
      return f.template operator()<Kdop<26>, StandardOverlap>();
  }
  return f.template operator()<Obb, StandardOverlap>();
}

/// Calls `query(Overlap{}, tree of a, tree of b)` with the two bodies' binary trees of a kind,
/// which are built if necessary. @pre not `TreeKind::obb4`.
template <class Query>
decltype(auto) onVolumeTrees(TreeKind trees, const Body& a, const Body& b, const Query& query) {
  return withVolume(trees, [&]<class Volume, class Overlap>() {
    return query(Overlap{}, a.volumeTree<Volume>(), b.volumeTree<Volume>());
  });
}

}  // namespace corridor
