#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/motion/certify_motion.h"
#include "collision/motion/rigid_motion.h"

namespace corridor {

/// A named mesh whose tree is built when a query first needs it (thread-safe). Immutable otherwise.
class Body {
 public:
  /// @throws std::invalid_argument if the mesh has no triangle, or `checkMesh` complains.
  Body(std::string name, TriangleMesh mesh, const ObbTreeParams& params = {});
  ~Body();
  Body(Body&&) noexcept;
  Body& operator=(Body&&) noexcept;

  const std::string& name() const;
  const TriangleMesh& mesh() const;
  const ObbTree& tree() const;  ///< builds it if nobody has
  bool treeBuilt() const;
  /// Radius about the origin (the body's reference point) of all corners, rounded up.
  double radius() const;
  /// A sphere around all corners: centre, and radius rounded up.
  const Vec3& sphereCenter() const;
  double sphereRadius() const;
  const Vec3& lower() const;  ///< axis-aligned bounds of the corners
  const Vec3& upper() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One rigid body of several meshes, `moving`, among `fixed` ones, which are at the identity. All
/// const after construction, trees apart (built at first need): with one QueryContext a thread
/// every query may be called in parallel.
class Scene {
 public:
  Scene(std::vector<Body> moving, std::vector<Body> fixed);

  const std::vector<Body>& moving() const { return moving_; }
  const std::vector<Body>& fixed() const { return fixed_; }
  /// Radius about the reference point of all moving meshes.
  double movingRadius() const { return movingRadius_; }
  /// 1e-7 of the smaller of the two sides' radii (each side's bodies in one sphere).
  double defaultTolerance() const;

  /// All queries throw std::invalid_argument for poses that are not finite, a zero quaternion, and
  /// options that are not finite or out of range; they build the trees that they need.

  /// Exact: do closed triangles of the two sides share a point, with the moving side under X_WB?
  /// First contact found.
  std::optional<Contact> interference(const Transform& X_WB, QueryContext& context) const;

  /// Is the motion from `from` to `to` free: straight line and slerp by the shorter arc (design:
  /// «What an edge is»)?
  MotionResult certifyEdge(const RigidPose& from, const RigidPose& to, const MotionOptions& options,
                           QueryContext& context) const;
  /// The same in the plane: (x, y, yaw), metres and radians, the shorter way round, z = 0.
  MotionResult certifyEdgePlanar(const Vec3& from, const Vec3& to, const MotionOptions& options,
                                 QueryContext& context) const;
  /// An edge of zero length.
  MotionResult certifyState(const RigidPose& pose, const MotionOptions& options,
                            QueryContext& context) const;
  MotionResult certifyStatePlanar(const Vec3& xyYaw, const MotionOptions& options,
                                  QueryContext& context) const;

 private:
  MotionResult certify(const RigidMotion& motion, const MotionOptions& options,
                       QueryContext& context) const;

  std::vector<Body> moving_, fixed_;
  double movingRadius_ = 0;
};

}  // namespace corridor
