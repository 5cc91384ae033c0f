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

/// The OBBTree of Gottschalk, Lin, Manocha 1996, laid out for SIMD: nodes of four oriented boxes in
/// float, tested sixteen pairs at a time; leaves of at most four triangles, whose doubles decide.
///
/// A binary top-down tree (planes through the area-weighted mean, orthogonal to the direction of
/// the largest area-weighted variance) of which about every second level is kept. All boxes are in
/// the tree's own frame and unit: x = (p − origin)·2^-unit, so that |x_i| ≤ 1 wherever the mesh is,
/// and float's error is 2^-24 of the mesh. Of meshes above 2^960 m queries look at all triangles.
///
/// Immutable. Keeps a copy of the mesh's vertices, so that the mesh may go.
class WideObbTree {
 public:
  static constexpr int kWidth = 4;                    ///< boxes of a node
  static constexpr int kLeafSize = 4;                 ///< triangles of a leaf, at most
  static constexpr std::uint32_t kNone = 0xffffffff;  ///< child of a lane that holds no box

  /// Four boxes in the tree's frame, half_0 the largest, and what each holds.
  struct alignas(64) Node : Obb4 {
    std::uint32_t child[kWidth];
  };
  /// Holds all: what is asked first.
  const Obb1& root() const { return root_; }
  /// What a box holds: the node of its parts, or a leaf's triangles.
  static bool isLeaf(std::uint32_t child) { return child >> 31 != 0; }
  static std::uint32_t leafFirst(std::uint32_t child) { return (child & 0x7fffffff) >> 2; }
  static std::uint32_t leafCount(std::uint32_t child) { return (child & 3) + 1; }

  /// The tree is bit for bit the same for any number of threads and on any instruction set; threads
  /// pay from some ten thousand triangles on. None is left when this returns.
  /// @throws std::invalid_argument for no triangle and for a mesh that `checkMesh` complains about,
  /// std::length_error for 2^29 − 1 triangles or more.
  explicit WideObbTree(const TriangleMesh& mesh, ObbFit fit = ObbFit::triangles,
                       unsigned threads = 1);
  /// One box, which holds a convex solid: its only item, number 0. @pre a sound part
  /// (`checkPrimitive`).
  explicit WideObbTree(const ConvexPart& part);

  /// The solid, or null: the leaves hold triangles.
  const ConvexPart* part() const { return part_ ? &*part_ : nullptr; }

  /// Depth first; node 0 has the parts of the whole.
  const std::vector<Node>& nodes() const { return nodes_; }
  std::size_t triangleCount() const { return triangles_.size(); }
  /// Of the i-th triangle in leaf order: its corners, and its number in the mesh.
  const Vec3& corner(std::uint32_t i, int k) const { return vertices_[triangles_[i][k]]; }
  Triangle triangle(std::uint32_t i) const { return {corner(i, 0), corner(i, 1), corner(i, 2)}; }
  std::uint32_t meshTriangle(std::uint32_t i) const { return meshTriangle_[i]; }

  const Vec3& origin() const { return origin_; }
  /// 2^unit, metres.
  double length() const { return length_; }
  /// Largest |p − origin|₂ of all points, metres, rounded up.
  double radius() const { return radius_; }
  /// Of a sphere about the frame's origin, metres: holds all points.
  double reach() const { return reach_; }

  std::size_t bytes() const;

  /// Proves in rationals that every box contains every triangle (or the solid) below it, that each
  /// is in exactly one leaf, and that every node is the child of one box. Returns the first
  /// complaint.
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
