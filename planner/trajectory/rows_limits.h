#pragma once

#include "planner/trajectory/limits_proof.h"
#include "planner/trajectory/trajectory_curve.h"

namespace corridor {

/// The rows of a file define a curve. For each limit, returns an upper bound of the ratio of the
/// curve's largest value to the limit. `proveLimits` does the same for the rows of a time law.
/// Velocities, link speeds and positions are always tested. Accelerations are tested for cubic and
/// quintic rows (the velocity of linear rows jumps at rows), and jerks only for quintic rows. If an
/// acceleration or jerk has a limit but is not tested, its `share` is 0 and `tested` is false. If
/// the processor's floating-point mode makes the bounds invalid (collision/core/floating_point.h),
/// each of the four shares (velocity, acceleration, jerk and link speed) that is above 0 becomes
/// infinite.
/// @pre The rows have times. They also have the velocities and accelerations that the polynomials
/// of `between` are made of.
LimitRatios limitsOfRows(const TrajectoryRows& rows, RowInterpolation between,
                         const ConfigurationSpace& space, const JointLimits& limits,
                         const KinematicTree& tree);

/// The excess that `exceedsLimits` tolerates because of rounding: as a fraction of a limit, and as
/// metres or radians beyond the bound of a position.
inline constexpr double kLimitSlack = 0x1p-40;

/// Returns whether the upper bound of a tested ratio is above 1 + kLimitSlack, or a position is
/// more than kLimitSlack beyond its bounds. (The limit itself may still be kept, because the ratio
/// is an upper bound.) The rounding of an upper bound is below 2^-44 of it, except for the angular
/// acceleration of rotations (`proveLimits`). A motion exactly at a limit may therefore have a
/// bound above 1; so a ratio of up to 1 + kLimitSlack counts as kept. For positions, kLimitSlack is
/// less than the default tube.
bool exceedsLimits(const LimitRatios& ratios);
/// Returns whether all limits are kept at every instant: no limit is exceeded (`exceedsLimits`),
/// and each limit that is given was tested.
bool keepsLimits(const LimitRatios& ratios);
/// Returns "kept", "exceeded" or "not tested". "not tested" means that no limit is exceeded, but
/// some limits were not tested.
const char* limitsVerdict(const LimitRatios& ratios);

}  // namespace corridor
