#pragma once

#include "planner/trajectory/limits_proof.h"
#include "planner/trajectory/trajectory_curve.h"

namespace corridor {

/// Proves the limits of the curve that the rows of a file mean, as `proveLimits` does for rows of a
/// law. Linear rows have limits of velocity only: their velocity jumps at rows. Cubic rows have
/// limits of velocity and acceleration, and quintic rows of jerk, too. Shares of other limits that
/// are given are 0 and not `tested`. If the processor's floating-point mode makes the bounds
/// invalid (collision/core/floating_point.h), shares of what moves are infinite.
/// @pre the rows have times, and what `between` needs.
LimitRatios limitsOfRows(const TrajectoryRows& rows, Between between,
                         const ConfigurationSpace& space, const JointLimits& limits,
                         const KinematicTree& tree);

/// What `keepsLimits` allows for rounding: a share of a limit, and metres or radians beyond a
/// bound.
inline constexpr double kLimitSlack = 0x1p-40;

/// Returns whether a limit that was tested is exceeded at some instant, by its upper
/// bound. Shares are upper bounds, whose own rounding is below 2^-44 of them. So a share of up to
/// 1 + kLimitSlack counts as kept: otherwise a motion exactly at a limit would exceed it. For the
/// same reason, positions may be up to kLimitSlack beyond the bounds, less than the default tube.
bool exceedsLimits(const LimitRatios& ratios);
/// Returns whether all limits are kept at every instant: none is exceeded, and each that is given
/// was tested.
bool keepsLimits(const LimitRatios& ratios);
/// Returns "kept", "exceeded" or "not tested": none is exceeded, but some were not tested.
const char* limitsVerdict(const LimitRatios& ratios);

}  // namespace corridor
