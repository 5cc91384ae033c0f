#pragma once

#include "collision/motion/rigid_motion.h"
#include "collision/world/scene.h"

namespace corridor {

/// A `Scene` in which the bodies `moving` move as one rigid body among the bodies `fixed`, which
/// stand still in the world. Like a `Scene`, it is const after construction. Threads may share it,
/// each with its own `QueryContext`.
class RigidScene {
 public:
  /// In `scene()` the fixed bodies come first, on frame 0; the moving bodies follow, on frame 1.
  /// @throws std::invalid_argument if `moving` is empty.
  RigidScene(std::vector<Body> moving, std::vector<Body> fixed);

  const Scene& scene() const { return scene_; }
  std::span<const Scene::Placed> fixed() const { return {scene_.bodies().data(), fixedCount_}; }
  std::span<const Scene::Placed> moving() const {
    return std::span(scene_.bodies()).subspan(fixedCount_);
  }
  /// Returns `scene().defaultTolerance(farthest)`.
  /// @param farthest the largest distance of a pose of any edge from the origin, metres.
  double defaultTolerance(double farthest = 0) const { return scene_.defaultTolerance(farthest); }

  /// All queries throw std::invalid_argument for poses that are not finite, for a zero quaternion,
  /// and for options or tubes with numbers that are not finite or are out of range.

  /// Returns a contact of the moving bodies under X_WB, or nullopt. `Scene::interference` states
  /// how exact the answer is.
  std::optional<Contact> interference(const Transform& X_WB, QueryContext& context) const;

  /// Decides whether the motion from `from` to `to` is free. The position moves on a straight line,
  /// and the orientation by slerp along the shorter arc (collision/PROMISES.md, "What an edge is").
  /// @param tube the deviations from the nominal curve that the proof covers.
  MotionResult certifyEdge(const RigidPose& from, const RigidPose& to, const MotionOptions& options,
                           QueryContext& context, const Tube& tube = {}) const;
  /// Decides whether a motion in the plane z = 0 is free. Poses are (x, y, yaw), in metres and
  /// radians. The body rotates from the first yaw to the second in the direction of the smaller
  /// angle.
  MotionResult certifyEdgePlanar(const Vec3& from, const Vec3& to, const MotionOptions& options,
                                 QueryContext& context, const Tube& tube = {}) const;
  /// Decides whether a state is free. The state is treated as an edge of zero length.
  MotionResult certifyState(const RigidPose& pose, const MotionOptions& options,
                            QueryContext& context, const Tube& tube = {}) const;
  MotionResult certifyStatePlanar(const Vec3& xyYaw, const MotionOptions& options,
                                  QueryContext& context, const Tube& tube = {}) const;

 private:
  Scene scene_;
  std::size_t fixedCount_;
};

}  // namespace corridor
