#pragma once

#include <memory>
#include <span>

#include "collision/motion/certify_motion.h"
#include "collision/world/scene.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// The motions of the frames of a tree along an edge of its configuration space, as `Scene` asks
/// for them. Poses are computed where they are asked for, at most once a window; relative motions
/// run over the joints between the two frames only (numerics: «Relative motion»). All rounding
/// (interpolation, sine, kinematics) is a bound per frame, kept as a running error along the chain.
///
/// One object a thread; `set` for every edge, without allocating after the first.
class EdgeMotion final : public MotionSource {
 public:
  /// All must outlive the object. @param tube for each number of a Configuration, how far it may
  /// stray (metres; radians; of a rotation the first of its four numbers counts, radians), ≥ 0.
  /// @throws std::runtime_error where the processor is set so that no bound holds
  /// (collision/core/floating_point.h).
  EdgeMotion(const KinematicTree& tree, const ConfigurationSpace& space,
             std::span<const Scene::FramePair> pairs, const Configuration& tube);
  ~EdgeMotion() override;

  /// @pre finite, of the space's size; quaternions not zero.
  void set(const Configuration& from, const Configuration& to);

  MotionWindow window(std::size_t pair, double t, double h) override;
  bool ambiguous() const override;
  bool still() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor
