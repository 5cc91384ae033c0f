#pragma once

#include "planner/trajectory/limits_proof.h"
#include "planner/trajectory/trajectory_curve.h"

namespace corridor {

/// Proves the limits of the curve that the rows of a file mean, as `proveLimits` does for the rows
/// of a time law. For linear rows, only limits of velocity are tested, because their velocity jumps
/// at rows. For cubic rows, limits of acceleration are tested, too, and for quintic rows also
/// limits of jerk. For each other limit that is given, the share is 0 and `tested` is false. If the
/// processor's floating-point mode makes the bounds invalid (collision/core/floating_point.h),
/// every share of a velocity, acceleration, jerk or link speed that is above 0 becomes infinite.
/// @pre the rows have times, and what `between` needs.
LimitRatios limitsOfRows(const TrajectoryRows& rows, RowInterpolation between,
                         const ConfigurationSpace& space, const JointLimits& limits,
                         const KinematicTree& tree);

/// What `exceedsLimits` allows for rounding: a share of a limit, and metres or radians beyond a
/// bound.
inline constexpr double kLimitSlack = 0x1p-40;

/// Returns whether the proved upper bound of a tested share is above 1 + kLimitSlack. (The limit
/// may still be kept.) The rounding of an upper bound is below 2^-44 of it. A motion exactly at a
/// limit may therefore have a bound above 1; so a share of up to 1 + kLimitSlack counts as kept.
/// For the same reason, positions may be up to kLimitSlack beyond the bounds, less than the default
/// tube.
bool exceedsLimits(const LimitRatios& ratios);
/// Returns whether all limits are kept at every instant: none is exceeded, and each that is given
/// was tested.
bool keepsLimits(const LimitRatios& ratios);
/// Returns "kept", "exceeded" or "not tested". The last one means that no limit is exceeded, but
/// some limits were not tested.
const char* limitsVerdict(const LimitRatios& ratios);

}  // namespace corridor
