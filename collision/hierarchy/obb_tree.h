#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/predicates/triangle.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// How an ObbTree is built.
struct ObbTreeParams {
  ObbFit fit = ObbFit::triangles;
};

/// The OBBTree of Gottschalk, Lin, Manocha 1996: a binary tree of oriented boxes over the triangles
/// of a mesh, built top-down. A node's triangles are split by the plane through their mean (as the
/// fit weighs it) orthogonal to the longest axis of the box, by the sides on which their centroids
/// lie; where that separates nothing, by the second and the third axis, else the node is an
/// indivisible leaf. All other leaves have one triangle.
///
/// Immutable. Keeps a copy of the corners, in leaf order, so that the mesh may go. Depth is not
/// bounded (triangles of size 2^-i around a point give a depth of thousands): who walks a tree
/// keeps a stack of its own.
class ObbTree {
 public:
  struct Node {
    Obb box;
    double radius = 0;  ///< of the smallest sphere about box.center that holds the box, rounded up
    std::uint32_t first = 0;  ///< its triangles: [first, first + count) of `triangles()`
    std::uint32_t count = 0;
    std::uint32_t right = 0;  ///< the right child; the left one follows the node. 0: a leaf
    bool isLeaf() const { return right == 0; }
  };

  /// @pre the mesh has a triangle, finite coordinates, and indices in range (`checkMesh`).
  explicit ObbTree(const TriangleMesh& mesh, const ObbTreeParams& params = {});
  /// One leaf, which holds a convex part: no triangles, `count` 0. @pre a sound part
  /// (`checkPrimitive`).
  explicit ObbTree(const ConvexPart& part);

  /// What the one leaf holds, or null: the leaves hold triangles.
  const ConvexPart* part() const { return part_ ? &*part_ : nullptr; }

  /// Depth first; the root is node 0.
  const std::vector<Node>& nodes() const { return nodes_; }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  /// Corners in leaf order, and each one's number in the mesh.
  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::uint32_t meshTriangle(std::uint32_t i) const { return meshTriangle_[i]; }

  /// Bounds for the margins of overlap tests: the largest orthonormality defect of the axes, the
  /// largest |center|₂, rounded up.
  double axisDefect() const { return axisDefect_; }
  double centerReach() const { return centerReach_; }
  /// Largest |x|₂ of all points, rounded up.
  double reach() const { return reach_; }

  std::size_t depth() const;
  std::size_t bytes() const;

  /// Proves in rationals that every node's box, as the set that `Obb` says, contains every triangle
  /// of the node, or the part with its ball or discs, that each triangle is in exactly one leaf,
  /// and that children partition their parents. Returns the first complaint.
  std::optional<std::string> check() const;

 private:
  void addNode(const Node& node);

  std::vector<Node> nodes_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> meshTriangle_;
  std::optional<ConvexPart> part_;
  double axisDefect_ = 0, centerReach_ = 0, reach_ = 0;
};

}  // namespace corridor
