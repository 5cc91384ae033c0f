#pragma once

#include "planner/trajectory/limits_proof.h"
#include "planner/trajectory/trajectory_curve.h"

namespace corridor {

/// Proves the limits of the curve that the rows of a file mean, as `proveLimits` does for rows of a
/// law. Linear rows have limits of velocity only: their velocity jumps at rows. Cubic rows have
/// limits of velocity and acceleration, and quintic rows of jerk, too. Shares that are not bounded
/// are 0.
/// @pre the rows have times, and what `between` needs.
LimitRatios limitsOfRows(const TrajectoryRows& rows, Between between,
                         const ConfigurationSpace& space, const JointLimits& limits,
                         const KinematicTree& tree);

/// Returns whether no limit is exceeded at any instant.
bool keepsLimits(const LimitRatios& ratios);

}  // namespace corridor
