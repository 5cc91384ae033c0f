#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/predicates/triangle.h"
#include "collision/volumes/obb.h"
#include "collision/volumes/obb4.h"

namespace corridor {

struct Obb4Frame;
struct Obb4Layout;

/// The 4-wide OBB tree: the OBBTree of Gottschalk, Lin, Manocha 1996, laid out for SIMD. A node has
/// four oriented boxes in float, and sixteen pairs of boxes are tested at a time. A leaf has at
/// most four triangles. Most pairs of triangles are decided in float, the others in double or
/// exactly.
///
/// The tree is a binary tree, built top-down, of which about every second level is kept. With the
/// default fit, clusters are split by planes through the area-weighted mean, orthogonal to the
/// direction of the largest area-weighted variance. All boxes are in the tree's own frame and unit,
/// x = (p − origin)·2^-unit. Everywhere on the mesh |x_i| ≤ 1, so rounding to float moves a
/// coordinate by at most 2^-24 of the mesh's size. For meshes above 2^960 m no box is used: queries
/// test all triangles.
///
/// Immutable except for `refit`. The tree keeps a copy of the mesh's vertices, so the mesh need not
/// outlive it.
class Obb4Tree {
 public:
  static constexpr int kWidth = 4;                    ///< boxes per node
  static constexpr int kLeafSize = 4;                 ///< largest number of triangles per leaf
  static constexpr std::uint32_t kNone = 0xffffffff;  ///< child of a lane that holds no box

  /// Four boxes in the tree's frame, and the child of each. half[0] is a box's largest half extent.
  struct alignas(64) Node : Obb4 {
    std::uint32_t child[kWidth];
  };
  /// The box around the whole tree: queries test it first.
  const Obb1& root() const { return root_; }
  /// The child of a box is the number of an inner node, or a leaf: a range of triangles or parts.
  /// `isLeaf` is also true for `kNone`.
  static bool isLeaf(std::uint32_t child) { return child >> 31 != 0; }
  static std::uint32_t leafFirst(std::uint32_t child) { return (child & 0x7fffffff) >> 2; }
  static std::uint32_t leafCount(std::uint32_t child) { return (child & 3) + 1; }

  /// Builds the tree over the triangles of `mesh`. The tree is bit for bit the same for any number
  /// of threads and on any instruction set. More threads save time from some ten thousand triangles
  /// on. All threads have ended when the constructor returns.
  /// @throws std::invalid_argument if the mesh has no triangle or `checkMesh` finds a fault,
  /// std::length_error for 2^29 − 1 triangles or more.
  explicit Obb4Tree(const TriangleMesh& mesh, ObbFit fit = ObbFit::triangles, unsigned threads = 1);
  /// The tree of a layout that was kept. @pre `layout` is what `layout()` of a tree over an equal
  /// mesh returned.
  Obb4Tree(const TriangleMesh& mesh, Obb4Layout layout);
  /// A tree over convex parts, which may overlap. Each leaf holds one part. The tree shares the
  /// parts with the caller. @pre All parts are valid: they were made of primitives in which
  /// `checkPrimitive` finds no fault.
  /// @throws std::invalid_argument if there are no parts, std::length_error for 2^29 − 1 parts or
  /// more.
  explicit Obb4Tree(std::shared_ptr<const std::vector<ConvexPart>> parts, unsigned threads = 1);
  /// A tree of one box, which holds one part.
  explicit Obb4Tree(const ConvexPart& part)
      : Obb4Tree(std::make_shared<const std::vector<ConvexPart>>(1, part)) {}

  bool hasParts() const { return parts_ != nullptr; }  ///< false: the leaves hold triangles
  /// The i-th part in leaf order. @pre `hasParts()`.
  const ConvexPart& part(std::uint32_t i) const { return (*parts_)[meshTriangle_[i]]; }

  /// The nodes, in depth-first order. Node 0 is the root.
  const std::vector<Node>& nodes() const { return nodes_; }
  std::size_t triangleCount() const { return triangles_.size(); }  ///< 0 for parts
  std::size_t itemCount() const { return meshTriangle_.size(); }   ///< triangles or parts
  /// These return, for the i-th triangle in leaf order, its corner k, the whole triangle, and its
  /// number in the mesh. For a tree over parts, `meshTriangle` returns the number of the i-th part
  /// in the list of parts.
  const Vec3& corner(std::uint32_t i, int k) const { return vertices_[triangles_[i][k]]; }
  Triangle triangle(std::uint32_t i) const { return {corner(i, 0), corner(i, 1), corner(i, 2)}; }
  std::uint32_t meshTriangle(std::uint32_t i) const { return meshTriangle_[i]; }

  const Vec3& origin() const { return origin_; }
  /// The length of the tree's unit: 2^unit metres.
  double length() const { return length_; }
  /// Radii of two spheres that contain all points, metres, rounded up. `radius()` is that of a
  /// sphere about `origin()`; `reach()` is that of a sphere about the origin of the mesh's frame.
  double radius() const { return radius_; }
  double reach() const { return reach_; }

  /// Fits the boxes to triangles that have moved. The tree keeps its structure, and each box keeps
  /// its axes; the frame and the unit of the tree are computed again from the new coordinates.
  /// Refitting is cheaper than building, but boxes get looser the more the mesh deforms. The result
  /// depends on the axes, the structure and `moved`. The positions before the call affect only
  /// rounding and the order of a box's sides. No query may run at the same time.
  /// @throws std::invalid_argument if the leaves hold parts, if `moved` has another number of
  /// triangles than the tree, or if `checkMesh` finds a fault. The tree is then unchanged.
  void refit(const TriangleMesh& moved);

  /// Returns a copy of all that was computed for the mesh.
  Obb4Layout layout() const;

  std::size_t bytes() const;

 private:
  void take(Obb4Layout layout);
  void takeTriangles(const TriangleMesh& mesh, unsigned threads);
  void take(const Obb4Frame& frame);

  Obb1 root_ = {};
  std::vector<Node> nodes_;
  std::vector<Vec3> vertices_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> meshTriangle_;
  std::shared_ptr<const std::vector<ConvexPart>> parts_;
  Vec3 origin_ = Vec3::Zero();
  double length_ = 1;
  double radius_ = 0, reach_ = 0;
};

}  // namespace corridor
