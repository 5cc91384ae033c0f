#pragma once

#include "collision/world/scene.h"
#include "planner/checker/context_pool.h"
#include "planner/checker/rigid_state.h"

namespace corridor {

/// What a rigid body's states and edges are checked for; the plain half of the OMPL classes beside
/// it. Safe to call from many threads at once.
class RigidChecker {
 public:
  /// Bounds of the reference point, inclusive (SE2: x and y). The scene must outlive the checker.
  /// `options.earliest` is ignored.
  RigidChecker(const Scene& scene, RigidSpace space, const Vec3& lower, const Vec3& upper,
               const MotionOptions& options);

  const Scene& scene() const { return scene_; }
  RigidSpace space() const { return space_; }
  const MotionOptions& options() const { return options_; }

  bool inBounds(const RigidState& state) const;
  /// Bounds aside. @pre finite.
  MotionResult state(const RigidState& at) const;
  /// Bounds aside. @pre finite.
  MotionResult edge(const RigidState& from, const RigidState& to, bool earliest) const;
  /// Exact static interference of triangles: neither margin nor tolerance nor tube. @pre finite.
  std::optional<Contact> interference(const RigidState& at) const;

  /// In bounds and `state` is free.
  bool certifiedState(const RigidState& at) const;
  /// Both ends in bounds (so all of it is) and `edge` is free.
  bool certifiedEdge(const RigidState& from, const RigidState& to) const;

  /// Of all threads; call it while no query runs.
  Counters counters() const { return contexts_.total(); }

 private:
  const Scene& scene_;
  RigidSpace space_;
  Vec3 lower_, upper_;
  MotionOptions options_;
  mutable ContextPool contexts_;
};

}  // namespace corridor
