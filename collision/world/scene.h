#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/counters.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/motion/rigid_motion.h"

namespace corridor {

class QueryContext;
class ObbTree;

/// A named mesh whose tree is built when a query first needs it (thread-safe). Immutable otherwise.
class Body {
 public:
  Body(std::string name, TriangleMesh mesh);
  ~Body();
  Body(Body&&) noexcept;
  Body& operator=(Body&&) noexcept;

  const std::string& name() const;
  const TriangleMesh& mesh() const;
  const ObbTree& tree() const;  ///< builds it if nobody has
  bool treeBuilt() const;
  /// Smallest sphere about `origin` (the body's reference point) that holds the mesh, rounded up.
  double radius() const;
  const Vec3& lower() const;  ///< axis-aligned bounds of the vertices
  const Vec3& upper() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One contact of a static query.
struct Contact {
  std::size_t movingBody = 0, fixedBody = 0;          ///< indices into the scene's lists
  std::uint32_t movingTriangle = 0, fixedTriangle = 0;
};

enum class MotionVerdict { free, contact, undecided };
enum class UndecidedReason { none, clearance, workLimit, ambiguous };

/// The answer of a motion query (design: contract 2).
struct MotionResult {
  MotionVerdict verdict = MotionVerdict::free;
  UndecidedReason reason = UndecidedReason::none;
  /// [0, certifiedUntil] is proved free (for `free`: 1). If the query did not ask for the earliest contact it is 0.
  double certifiedUntil = 1;
  double contactTime = -1;       ///< t1 of `contact`, else −1; for `undecided` the middle of the undecided interval
  bool grazing = false;          ///< `contact`, and the clearance stays under the tolerance over [certifiedUntil, contactTime]
  std::optional<Contact> pair;   ///< of `contact` and `undecided` (not for `ambiguous`)
  double gap = 0;                ///< `undecided`: distance of that pair found at contactTime, metres
};

/// Parameters of a motion query.
struct MotionOptions {
  double tolerance = 0;      ///< metres; below this clearance the answer may be `undecided`. Must be > 0.
  double margin = 0;         ///< metres kept from every obstacle; 0: touching is contact
  Tube tube;                 ///< what the proof covers beside the nominal curve
  bool earliest = false;     ///< find `certifiedUntil` too, not just the verdict
  double timeTolerance = 1.0 / 1024;  ///< of [0, 1]; how narrow a bracket `earliest` asks for
  std::uint64_t workLimit = 20'000'000;  ///< box and triangle tests, after which the answer is `undecided`
};

/// One rigid body of several meshes, `moving`, among `fixed` ones, which are at the identity. All const after
/// construction, trees apart (built at first need): one QueryContext a thread makes every query safe to call in parallel.
class Scene {
 public:
  Scene(std::vector<Body> moving, std::vector<Body> fixed);

  const std::vector<Body>& moving() const { return moving_; }
  const std::vector<Body>& fixed() const { return fixed_; }
  /// Radius about the reference point of all moving meshes.
  double movingRadius() const { return movingRadius_; }
  /// 1e-7 of the smaller bounding radius of the two sides.
  double defaultTolerance() const;

  /// Exact: do closed triangles of the two sides share a point, with the moving side under X_WB? First contact found.
  std::optional<Contact> interference(const Transform& X_WB, QueryContext& context) const;

  /// Is the motion from `from` to `to` free: straight line and slerp by the shorter arc (design: «What an edge is»)?
  MotionResult certifyEdge(const RigidPose& from, const RigidPose& to, const MotionOptions& options,
                           QueryContext& context) const;
  /// The same in the plane: yaw angles in radians, the shorter way round, z = 0.
  MotionResult certifyEdgePlanar(const Eigen::Vector3d& fromXyYaw, const Eigen::Vector3d& toXyYaw,
                                 const MotionOptions& options, QueryContext& context) const;
  /// An edge of zero length.
  MotionResult certifyState(const RigidPose& pose, const MotionOptions& options, QueryContext& context) const;
  MotionResult certifyStatePlanar(const Eigen::Vector3d& xyYaw, const MotionOptions& options,
                                  QueryContext& context) const;

 private:
  std::vector<Body> moving_, fixed_;
  double movingRadius_ = 0;
};

}  // namespace corridor
