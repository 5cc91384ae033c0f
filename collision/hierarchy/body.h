#pragma once

#include <limits>
#include <memory>
#include <string>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/mesh_components.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/hierarchy/wide_obb_tree.h"

namespace corridor {

/// A named shape, a mesh or a convex primitive, whose trees are built when a query first needs them
/// (thread-safe). Immutable otherwise. In the coordinates of the frame that it is fixed to.
class Body {
 public:
  /// A mesh: its surface, or with `solid` all that it encloses, too.
  /// @throws std::invalid_argument if the mesh has no triangle, or `checkMesh` complains, or it is
  /// to be solid and has a component that isn't watertight.
  Body(std::string name, TriangleMesh mesh, bool solid = false, const TreeParams& params = {});
  /// A solid primitive (`checkPrimitive` says what is wrong with one).
  /// @throws std::invalid_argument if it has no point or one that is not finite, or its radius is
  /// negative or not finite.
  Body(std::string name, ConvexPart part);
  ~Body();
  Body(Body&&) noexcept;
  Body& operator=(Body&&) noexcept;

  const std::string& name() const;
  const TriangleMesh& mesh() const;  ///< empty for a primitive
  const ConvexPart* part() const;    ///< null for a mesh
  bool solid() const;                ///< true for primitives
  const WideObbTree& tree() const;   ///< builds it if nobody has
  /// The binary tree of any kind of volume; builds it if nobody has.
  template <BoundingVolume Volume>
  const VolumeTree<Volume>& volumeTree() const;
  /// For the queries that have no wide variant.
  const ObbTree& binaryTree() const { return volumeTree<Obb>(); }
  const MeshComponents& components() const;  ///< of a mesh; found if nobody has
  bool treeBuilt() const;                    ///< any of them
  /// Radius about the origin of the frame of all points, rounded up.
  double radius() const { return bounds_.radius; }
  /// A sphere around all points: centre, and radius rounded up.
  const Vec3& sphereCenter() const { return bounds_.center; }
  double sphereRadius() const { return bounds_.sphereRadius; }
  const Vec3& lower() const { return bounds_.lower; }  ///< axis-aligned bounds
  const Vec3& upper() const { return bounds_.upper; }
  /// The sum of the bounds' magnitudes, metres: what roundings of differences to them go by.
  double boundTerms() const { return bounds_.terms; }

 private:
  struct Bounds {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower,
         center = Vec3::Zero();
    double radius = 0, sphereRadius = 0, terms = 0;

    template <class Each>
    void around(const Each& each, double grow, const Vec3& reach);
  };
  struct Impl;
  Bounds bounds_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor
