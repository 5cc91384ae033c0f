#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/tree_items.h"
#include "collision/hierarchy/tree_params.h"
#include "collision/predicates/triangle.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// A binary tree of bounding volumes over the triangles of a mesh, or over convex parts. Top-down
/// building splits a node's items (`SplitRule`) across the longest axis of its box; where that
/// separates nothing, by the second and the third axis, else the node is an indivisible leaf. All
/// other leaves have one item.
///
/// Immutable but for `refit`. Keeps a copy of the corners, in leaf order, so that the mesh may go.
/// Depth is not bounded (triangles of size 2^-i around a point give a depth of thousands): who
/// walks a tree keeps a stack of its own.
///
/// Made for Obb, Aabb, BoundingSphere, Rss, Kdop<14>, Kdop<18>, Kdop<26>.
template <BoundingVolume Volume>
class VolumeTree {
 public:
  struct Node {
    Volume box;               ///< the bounding volume, whatever its kind
    double radius = 0;        ///< of a sphere about the volume's centre that holds it, rounded up
    std::uint32_t first = 0;  ///< its items: [first, first + count) of `triangles()` or `parts()`
    std::uint32_t count = 0;
    std::uint32_t right = 0;  ///< the right child; the left one follows the node. 0: a leaf
    bool isLeaf() const { return right == 0; }
  };

  /// @throws std::invalid_argument for no triangle and for a mesh that `checkMesh` complains about.
  explicit VolumeTree(const TriangleMesh& mesh, const TreeParams& params = {});
  /// One leaf, which holds a convex part. @pre a sound part (`checkPrimitive`).
  explicit VolumeTree(const ConvexPart& part);
  /// Over many parts, which may overlap. @pre all sound. @throws std::invalid_argument for none.
  explicit VolumeTree(std::vector<ConvexPart> parts, const TreeParams& params = {});

  /// The i-th part, or null: the leaves hold triangles.
  const ConvexPart* part(std::uint32_t i = 0) const {
    return items_.parts.empty() ? nullptr : &items_.parts[i];
  }

  /// Depth first; the root is node 0.
  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  /// Calls f with the numbers of an inner node's children, the last one first: as they go on a
  /// stack.
  template <class F>
  void forEachChildBackwards(std::uint32_t i, F&& f) const {
    f(nodes_[i].right);
    f(i + 1);
  }
  /// Corners in leaf order, and each one's (or each part's) number in the mesh (or in the list).
  const std::vector<Triangle>& triangles() const { return items_.triangles; }
  const Triangle& triangle(std::uint32_t i) const { return items_.triangles[i]; }
  const std::vector<ConvexPart>& parts() const { return items_.parts; }
  std::uint32_t meshTriangle(std::uint32_t i) const { return items_.numbers[i]; }

  /// Bounds for the margins of overlap tests: the largest orthonormality defect of the axes, the
  /// largest |center|₂, rounded up.
  double axisDefect() const { return bounds_.axisDefect; }
  double centerReach() const { return bounds_.centerReach; }
  /// Largest |x|₂ of all points, rounded up.
  double reach() const { return bounds_.reach; }
  const VolumeBounds& bounds() const { return bounds_; }

  /// New volumes for the same triangles with other corners, each with the axes that it has: cheap,
  /// and looser the more the mesh deforms. No query may run meanwhile. @pre leaves hold triangles;
  /// `moved` is sound and has as many triangles as the mesh that the tree was built of.
  void refit(const TriangleMesh& moved);

  std::size_t depth() const;
  std::size_t bytes() const;

  /// Proves in rationals that every node's volume, as the set that its doubles say, contains every
  /// triangle of the node, or the parts with their balls or discs, that each item is in exactly one
  /// leaf, and that children partition their parents. Returns the first complaint.
  std::optional<std::string> check() const;

 private:
  void build(const TreeParams& params);
  void measure();

  std::vector<Node> nodes_;
  TreeItems items_;
  VolumeBounds bounds_;
};

}  // namespace corridor
