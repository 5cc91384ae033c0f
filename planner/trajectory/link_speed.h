#pragma once

#include <vector>

#include <Eigen/Core>

#include "planner/model/limits.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// Returns, for each link with a limit, the speed of its fastest point as a share of the limit.
/// @param velocity q̇; or dq/ds, and then the result is the share for ṡ = 1. The first three of a
/// rotation's four numbers are its angular velocity, in the coordinates of the frame before the
/// joint.
std::vector<double> linkSpeedShares(const KinematicTree& tree, const std::vector<LinkSpeed>& links,
                                    const Configuration& q, const Configuration& velocity);

/// Bounds of the points of a link.
struct PointBounds {
  double speed = 0, acceleration = 0;  ///< m/s, m/s²
};
/// Returns bounds that hold while each number's velocity and acceleration are at most `velocity`
/// and `acceleration` in absolute value, for all configurations whose translations and slides are
/// at most `reach` in absolute value.
PointBounds pointBounds(const KinematicTree& tree, const LinkSpeed& link,
                        const Configuration& reach, const Configuration& velocity,
                        const Configuration& acceleration);

}  // namespace corridor
