#pragma once

#include <memory>
#include <span>

#include "collision/motion/certify_motion.h"
#include "collision/world/scene.h"
#include "planner/robot/curve.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// The relative motions of the frames of a kinematic tree along one edge of its configuration
/// space, or along one piece of a curve, for queries of a `Scene`. A relative motion depends only
/// on the joints between its two frames. All rounding (interpolation, sine, kinematics) is
/// included: each frame has an error bound, accumulated along the chain.
///
/// Poses are computed on demand, at most once for each t. Use one object per thread. Call `set` for
/// every edge; after the first edge, `set` allocates no memory, and a query does so only if it is
/// the first one of its pair.
class EdgeMotion final : public MotionSource {
 public:
  /// `tree` and `space` must outlive the object.
  /// @param pairs the pairs of frames whose relative motions are queried; relative motion i belongs
  /// to pairs[i].
  /// @param tube for each number of a Configuration, the deviation from the edge that the motion
  /// bounds cover, ≥ 0 (metres or radians). The deviation of a rotation is an angle in radians,
  /// stored at the first of the rotation's four numbers.
  /// @throws std::invalid_argument if the tube has another length than a configuration, or a half
  /// width is negative or NaN.
  /// @throws std::runtime_error if the processor's floating-point mode makes the bounds invalid
  /// (collision/core/floating_point.h).
  EdgeMotion(const KinematicTree& tree, const ConfigurationSpace& space,
             std::span<const Scene::FramePair> pairs, const Configuration& tube);
  ~EdgeMotion() override;

  /// Sets the edge. If a number is not finite, or a quaternion is zero, the edge is `ambiguous`.
  /// @pre Both configurations have the space's size.
  void set(const Configuration& from, const Configuration& to);
  /// Sets a piece of a curve, whose parameter τ takes the place of t. The piece's `error` is added
  /// to the tube. Time intervals must be within [0, 1]. Queries must use `EdgeMethod::certified`,
  /// which keeps to this rule. If a coefficient or an error is not finite, an error is negative, or
  /// a first or last quaternion is zero, the piece is `ambiguous`. @pre There is one row and one
  /// error for each number of a configuration.
  void set(const CurvePiece& piece);

  RelativeMotion relativeMotion(std::size_t pair, double t, double h) override;
  bool ambiguous() const override;
  bool still() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace corridor
