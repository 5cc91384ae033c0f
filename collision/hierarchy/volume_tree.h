#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/tree_params.h"
#include "collision/hierarchy/tree_primitives.h"
#include "collision/predicates/triangle.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// A binary tree of bounding volumes over the triangles of a mesh, or over convex parts. Top-down
/// building splits a node's leaf primitives (`SplitRule`) across the longest axis of the node's
/// box. If this axis separates no primitives, the second and then the third axis is tried. If no
/// axis separates any primitives, the node is a leaf. All other leaves hold one leaf primitive.
///
/// Immutable except for `refit`. The tree keeps a copy of the corners, in leaf order, so the mesh
/// need not outlive it. The depth is not bounded: triangles of the sizes 2^-i around a point give a
/// very deep tree. A traversal therefore needs a stack of its own, and must not be recursive.
///
/// Instantiated for all volumes of the list CORRIDOR_EACH_VOLUME (volume_list.h).
template <BoundingVolume Volume>
class VolumeTree {
 public:
  struct Node {
    Volume box;               ///< the bounding volume, of any kind
    double radius = 0;        ///< largest distance of its points from its centre; rounded up
    std::uint32_t first = 0;  ///< its leaf primitives: a range of `triangles()` or `parts()`
    std::uint32_t count = 0;
    std::uint32_t right = 0;  ///< the right child; the left one follows the node. 0: a leaf
    bool isLeaf() const { return right == 0; }
  };

  /// @throws std::invalid_argument if the mesh has no triangle or `checkMesh` finds a fault.
  explicit VolumeTree(const TriangleMesh& mesh, const TreeParams& params = {});
  /// A tree of one leaf, which holds a convex part. @pre The part is valid: it was made of a
  /// primitive in which `checkPrimitive` finds no fault.
  explicit VolumeTree(const ConvexPart& part);
  /// A tree over many parts, which may overlap. @pre All parts are valid, as for a single part.
  /// @throws std::invalid_argument if the list is empty.
  explicit VolumeTree(std::vector<ConvexPart> parts, const TreeParams& params = {});

  bool hasParts() const { return !items_.parts.empty(); }  ///< false: the leaves hold triangles
  /// The i-th part, in leaf order. @pre `hasParts()`.
  const ConvexPart& part(std::uint32_t i) const { return items_.parts[i]; }

  /// The nodes, in depth-first order. Node 0 is the root.
  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  /// Calls f with the numbers of an inner node's children, the last child first. This is the order
  /// in which children are pushed on a stack.
  template <class F>
  void forEachChildBackwards(std::uint32_t i, F&& f) const {
    f(nodes_[i].right);
    f(i + 1);
  }
  /// The triangles in leaf order. `meshTriangle(i)` is the number of the i-th triangle in the mesh,
  /// or the number of the i-th part in the list of parts.
  const std::vector<Triangle>& triangles() const { return items_.triangles; }
  const Triangle& triangle(std::uint32_t i) const { return items_.triangles[i]; }
  const std::vector<ConvexPart>& parts() const { return items_.parts; }
  std::uint32_t meshTriangle(std::uint32_t i) const { return items_.numbers[i]; }

  /// Bounds that overlap tests need for their rounding errors, rounded up: the largest
  /// orthonormality defect of the axes, and the largest `centerReach()` of the volumes
  /// (volumes/volume.h).
  double axisDefect() const { return bounds_.axisDefect; }
  double centerReach() const { return bounds_.centerReach; }
  /// Largest |x|₂ of all points, rounded up.
  double reach() const { return bounds_.reach; }
  const VolumeBounds& bounds() const { return bounds_; }

  /// Fits the volumes again after the triangles have moved. Each volume keeps its axes. This is
  /// cheaper than building, but the tree gets looser the more the mesh deforms. No query may run at
  /// the same time. @pre The leaves hold triangles. `moved` has no fault (`checkMesh`) and as many
  /// triangles as the mesh of which the tree was built.
  void refit(const TriangleMesh& moved);

  std::size_t depth() const;
  std::size_t bytes() const;

 private:
  void build(const TreeParams& params);
  void measure();

  std::vector<Node> nodes_;
  TreePrimitives items_;
  VolumeBounds bounds_;
};

}  // namespace corridor
