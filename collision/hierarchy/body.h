#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/convex/convex_set.h"
#include "collision/geometry/convex_part.h"
#include "collision/geometry/mesh_components.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/box_tree.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/obb_tree.h"

namespace corridor {

class FileCache;

/// A named mesh, or a union of convex parts, in the coordinates of the frame to which the body is
/// fixed. Each tree is built when a query first needs it; this is thread-safe. Except for its
/// trees, a body is immutable. Equal bodies at different places can share one mesh and its trees
/// (`renamed`). The public constructors throw std::runtime_error unless standardFloatingPoint()
/// holds.
class Body {
 public:
  /// A mesh: its surface, or with `solid` also the space that the surface encloses.
  /// @throws std::invalid_argument if the mesh has no triangle, if `checkMesh` finds a fault, or if
  /// `solid` is set and a component isn't watertight.
  Body(std::string name, TriangleMesh mesh, bool solid = false, const TreeParams& params = {});
  /// A mesh that the body shares with the caller instead of copying it. Otherwise this constructor
  /// equals the one above. @pre `mesh` is not null.
  /// @param cache where to look for the tree and the hull of the mesh before they are computed, and
  /// to which they are offered then; null: none.
  Body(std::string name, std::shared_ptr<const TriangleMesh> mesh, bool solid = false,
       const TreeParams& params = {}, std::shared_ptr<FileCache> cache = nullptr);
  /// A convex part, which is solid. (`checkPrimitive` checks a primitive before it is made a part.)
  /// @throws std::invalid_argument if the part has no point, or a point that is not finite; if its
  /// radius is negative or not finite; or if it has flat ends and not exactly two points.
  Body(std::string name, ConvexPart part);
  /// The union of many parts, such as the balls about the points of a cloud. The parts may overlap.
  /// Each tree of the body holds all parts.
  /// @throws std::invalid_argument if there are no parts, or if the constructor for a single part
  /// would throw for one of them.
  Body(std::string name, std::vector<ConvexPart> parts);
  ~Body();
  Body(Body&&) noexcept;
  Body& operator=(Body&&) noexcept;
  /// Returns a body of another name that shares this body's mesh or parts, and all trees. A tree
  /// that one of them builds serves both.
  Body renamed(std::string name) const;

  const std::string& name() const { return name_; }
  bool isMesh() const { return parts().empty(); }
  const TriangleMesh& mesh() const;              ///< empty for convex parts
  const std::vector<ConvexPart>& parts() const;  ///< empty for a mesh
  bool solid() const;                            ///< true for convex parts
  /// Returns whether this is a solid mesh. A body inside a solid mesh need not touch the mesh's
  /// surface, so containment in it needs a separate test. (A body inside a convex part touches the
  /// part.)
  bool isSolidMesh() const { return solid() && isMesh(); }
  const Obb4Tree& tree() const;  ///< builds the tree if necessary
  /// Returns the binary tree of one kind of volume. Builds it if necessary.
  template <BoundingVolume Volume>
  const VolumeTree<Volume>& volumeTree() const;
  /// Returns the binary OBB tree, for queries that have no 4-wide variant. Builds it if necessary.
  const ObbTree& binaryTree() const { return volumeTree<Obb>(); }
  const MeshComponents& components() const;  ///< only for a mesh; computed at the first call
  /// The boxes of the parts, in the order of `parts()`; only for a body of parts. The tree of the
  /// boxes is built at the first call.
  const BoxTree& partBoxes() const;
  /// Returns a convex set that contains the body and mostly fits it: the only part of a body of
  /// parts, or `enclosingHull` of a mesh (convex/enclosing_hull.h). Returns nullptr if there is
  /// none. The hull is built at the first call.
  const ConvexSet* hull() const;
  bool treeBuilt() const;  ///< true if any tree except that of `partBoxes` has been built
  /// The largest distance of a point of the body from the frame's origin, metres, rounded up.
  double radius() const { return bounds_.radius; }
  /// A bounding sphere: its centre, and its radius, rounded up; metres.
  const Vec3& sphereCenter() const { return bounds_.center; }
  double sphereRadius() const { return bounds_.sphereRadius; }
  const BoundingBox& box() const { return bounds_.box; }
  const Vec3& lower() const { return bounds_.box.lower; }
  const Vec3& upper() const { return bounds_.box.upper; }

 private:
  struct Bounds {
    BoundingBox box;
    Vec3 center = Vec3::Zero();
    double radius = 0, sphereRadius = 0;

    template <class Each>
    void around(const Each& each);
  };
  struct Impl;
  Body(std::string name, const Bounds& bounds, std::shared_ptr<Impl> impl);

  std::string name_;
  Bounds bounds_;
  std::shared_ptr<Impl> impl_;
};

}  // namespace corridor
