#pragma once

#include "collision/convex/convex_set.h"
#include "collision/hierarchy/obb4_tree.h"

namespace corridor {

/// A leaf primitive of a 4-wide OBB tree as a convex set, and the corners that the set refers to.
class Obb4LeafSet {
 public:
  /// @param item the number of the leaf primitive in leaf order.
  Obb4LeafSet(const Obb4Tree& tree, std::uint32_t item)
      : corners_(tree.hasParts() ? Triangle() : tree.triangle(item)),
        set_(tree.hasParts() ? ConvexSet(tree.part(item)) : ConvexSet(corners_)) {}
  Obb4LeafSet(const Obb4LeafSet&) = delete;
  Obb4LeafSet& operator=(const Obb4LeafSet&) = delete;

  /// Returns the set. It is valid as long as this object and the tree exist.
  const ConvexSet& set() const { return set_; }

 private:
  Triangle corners_;
  ConvexSet set_;
};

}  // namespace corridor
