#pragma once

#include "collision/motion/rigid_motion.h"
#include "collision/world/scene.h"

namespace corridor {

/// The simple door to a `Scene`: one rigid body of several bodies, `moving`, among `fixed` ones,
/// which are at the identity. As `Scene`: const after construction, a QueryContext a thread.
class RigidScene {
 public:
  /// In `scene()` the fixed bodies come first, on frame 0; the moving ones follow, on frame 1.
  RigidScene(std::vector<Body> moving, std::vector<Body> fixed);

  const Scene& scene() const { return scene_; }
  std::span<const Scene::Placed> fixed() const { return {scene_.bodies().data(), fixedCount_}; }
  std::span<const Scene::Placed> moving() const {
    return std::span(scene_.bodies()).subspan(fixedCount_);
  }
  /// @param farthest  metres; the poses of edges are at most so far from the origin.
  double defaultTolerance(double farthest = 0) const { return scene_.defaultTolerance(farthest); }

  /// All queries throw std::invalid_argument for poses that are not finite, a zero quaternion, and
  /// numbers that are not finite or out of range.

  /// Exact, for the moving bodies under X_WB.
  std::optional<Contact> interference(const Transform& X_WB, QueryContext& context) const;

  /// Is the motion from `from` to `to` free: straight line and slerp by the shorter arc (design:
  /// «What an edge is»)? @param tube what the proof covers beside the nominal curve.
  MotionResult certifyEdge(const RigidPose& from, const RigidPose& to, const MotionOptions& options,
                           QueryContext& context, const Tube& tube = {}) const;
  /// The same in the plane: (x, y, yaw), metres and radians, the shorter way round, z = 0.
  MotionResult certifyEdgePlanar(const Vec3& from, const Vec3& to, const MotionOptions& options,
                                 QueryContext& context, const Tube& tube = {}) const;
  /// An edge of zero length.
  MotionResult certifyState(const RigidPose& pose, const MotionOptions& options,
                            QueryContext& context, const Tube& tube = {}) const;
  MotionResult certifyStatePlanar(const Vec3& xyYaw, const MotionOptions& options,
                                  QueryContext& context, const Tube& tube = {}) const;

 private:
  Scene scene_;
  std::size_t fixedCount_;
};

}  // namespace corridor
