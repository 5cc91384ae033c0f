#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/predicates/triangle.h"
#include "collision/volumes/obb.h"
#include "collision/volumes/obb4.h"

namespace corridor {

/// The 4-wide OBB tree: the OBBTree of Gottschalk, Lin, Manocha 1996, laid out for SIMD. Nodes have
/// four oriented boxes in float, tested sixteen pairs at a time. Leaves have at most four
/// triangles, which are tested in double.
///
/// It is a binary top-down tree of which about every second level is kept. Splits are by planes
/// through the area-weighted mean, orthogonal to the direction of the largest area-weighted
/// variance. All boxes are in the tree's own frame and unit, x = (p − origin)·2^-unit. So |x_i| ≤ 1
/// wherever the mesh is, and float's error is 2^-24 of the mesh. For meshes above 2^960 m queries
/// test all triangles.
///
/// Immutable. Keeps a copy of the mesh's vertices, so the mesh need not outlive it.
class Obb4Tree {
 public:
  static constexpr int kWidth = 4;                    ///< boxes per node
  static constexpr int kLeafSize = 4;                 ///< largest number of triangles per leaf
  static constexpr std::uint32_t kNone = 0xffffffff;  ///< child of a lane that holds no box

  /// Four boxes in the tree's frame, half_0 the largest, and the child of each.
  struct alignas(64) Node : Obb4 {
    std::uint32_t child[kWidth];
  };
  /// The box around the whole tree: queries test it first.
  const Obb1& root() const { return root_; }
  /// The child of a box is an inner node, or a leaf's range of triangles.
  static bool isLeaf(std::uint32_t child) { return child >> 31 != 0; }
  static std::uint32_t leafFirst(std::uint32_t child) { return (child & 0x7fffffff) >> 2; }
  static std::uint32_t leafCount(std::uint32_t child) { return (child & 3) + 1; }

  /// Builds the tree over the triangles of `mesh`. The tree is bit for bit the same for any number
  /// of threads and on any instruction set. More threads pay from some ten thousand triangles on.
  /// All have ended when this returns.
  /// @throws std::invalid_argument if the mesh has no triangle or `checkMesh` finds a fault,
  /// std::length_error for 2^29 − 1 triangles or more.
  explicit Obb4Tree(const TriangleMesh& mesh, ObbFit fit = ObbFit::triangles, unsigned threads = 1);
  /// A tree of one box, which holds a convex part: its only leaf primitive, number 0. @pre a sound
  /// part (`checkPrimitive`).
  explicit Obb4Tree(const ConvexPart& part);

  /// Returns the convex part, or null if the leaves hold triangles.
  const ConvexPart* part() const { return part_ ? &*part_ : nullptr; }

  /// Nodes, depth first. Node 0 is the root.
  const std::vector<Node>& nodes() const { return nodes_; }
  std::size_t triangleCount() const { return triangles_.size(); }
  /// The k-th corner of the i-th triangle in leaf order. `meshTriangle` is its number in the mesh.
  const Vec3& corner(std::uint32_t i, int k) const { return vertices_[triangles_[i][k]]; }
  Triangle triangle(std::uint32_t i) const { return {corner(i, 0), corner(i, 1), corner(i, 2)}; }
  std::uint32_t meshTriangle(std::uint32_t i) const { return meshTriangle_[i]; }

  const Vec3& origin() const { return origin_; }
  /// The tree's unit, 2^unit, in metres.
  double length() const { return length_; }
  /// Largest |p − origin|₂ of all points, metres, rounded up.
  double radius() const { return radius_; }
  /// Radius of a sphere about the frame's origin that contains all points, metres.
  double reach() const { return reach_; }

  std::size_t bytes() const;

  /// Proves three invariants in rational arithmetic. Every box contains every triangle below it (or
  /// the convex part). Each triangle is in exactly one leaf. Every node is the child of one box.
  /// Returns the first violation.
  std::optional<std::string> check() const;

 private:
  Obb1 root_ = {};
  std::vector<Node> nodes_;
  std::vector<Vec3> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> meshTriangle_;
  std::optional<ConvexPart> part_;
  Vec3 origin_ = Vec3::Zero();
  double length_ = 1;
  double radius_ = 0, reach_ = 0;
};

}  // namespace corridor
