#pragma once

#include <vector>

#include <Eigen/Core>

#include "planner/model/limits.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// Returns, for each element of `links`, the largest speed of its `points` in the world, divided by
/// the limit `speed`.
/// @param velocity q̇; or dq/ds, and then the results are the ratios for ṡ = 1. The first three of
/// a rotation's four components are its angular velocity, in the coordinates of the frame before
/// the joint.
std::vector<double> linkSpeedShares(const KinematicTree& tree, const std::vector<LinkSpeed>& links,
                                    const Configuration& q, const Configuration& velocity);

/// Bounds of the speed and acceleration of the points of a link in the world.
struct PointBounds {
  double speed = 0, acceleration = 0;  ///< m/s, m/s²
};
/// Returns bounds for the points of `link`. They hold for all configurations whose components for
/// translations and prismatic joints are at most `reach` in absolute value, while the velocity and
/// acceleration of each component are at most `velocity` and `acceleration` in absolute value.
PointBounds pointBounds(const KinematicTree& tree, const LinkSpeed& link,
                        const Configuration& reach, const Configuration& velocity,
                        const Configuration& acceleration);

}  // namespace corridor
