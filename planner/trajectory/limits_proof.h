#pragma once

#include <cstddef>
#include <vector>

#include "planner/model/limits.h"
#include "planner/robot/configuration_space.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// A row of a trajectory, in m, rad and s. A rotation has four components. In `velocity` and
/// `acceleration`, the first three of them are its angular velocity and angular acceleration, in
/// the coordinates of the frame before the joint.
struct TimedRow {
  double time = 0;  ///< seconds
  Configuration position, velocity, acceleration;
};

/// The largest ratio of a value to its limit, over all components of a Configuration (or over all
/// links), and where it was found.
struct LimitShare {
  double share = 0;        ///< the ratio; 1: the limit is reached
  std::size_t number = 0;  ///< index into a Configuration; for link speeds: into JointLimits::links
  double time = 0;         ///< seconds: the time of the row at which the interval begins
  /// False if a limit is given, but the rows do not determine the quantity that it limits
  /// (rows_limits.h).
  bool tested = true;
};

/// Upper bounds of the ratios of values to limits, valid at every instant of a trajectory.
struct LimitRatios {
  LimitShare velocity, acceleration, jerk, link;
  /// Here `share` is not a ratio. It is the largest distance, in m or rad, by which a line
  /// coordinate (Coordinate::Kind::line) leaves its bounds [lower, upper]; 0 if none leaves them.
  LimitShare position;
};

/// Returns, for each kind of limit, an upper bound of the ratio of value to limit over the whole
/// curve of the rows. The curve between two rows, in real arithmetic on the stored doubles, is
/// - degree 1: linear in time. Only position, velocity and link speed are bounded. If the velocity
///   of a component jumps at a row, and this component has a limit of acceleration, the ratio for
///   accelerations is infinite;
/// - degree 3: the cubic Hermite polynomial of positions and velocities;
/// - degree 5: the quintic Hermite polynomial of positions, velocities and accelerations.
/// The derivatives of this curve are polynomials in Bernstein form, so the coefficients bound the
/// derivatives. The position of a planar or floating joint has one limit for the length of its
/// vector; there, the lengths of the coefficient vectors are the bound. An interval is halved, at
/// most 24 times, until the bound is at most 1, is within 0.01 % of a value that is attained, is
/// within four times the rounding of it, or can no longer raise the result. All roundings are
/// included (row_polynomials.cpp, row_rotation.cpp). The jerk of the cubic is not bounded, because
/// its acceleration jumps at rows.
/// - Rotations are slerps of constant angular velocity between rows (curve.h), so this velocity
///   jumps at rows. Its length is bounded. In place of an angular acceleration, this quotient is
///   computed: the change of the angular velocity from one interval to the next, divided by the
///   mean of the two durations. For the durations S and T, the bound is above the quotient by at
///   most 2^-55 rad/(S·T), besides some u of it. If rows are half a turn apart, within 1e-9 rad, no
///   curve is defined, and the bounds of this quotient and of all link speeds are infinite.
/// - Speeds of links: the largest speed of the points of LinkSpeed, from the Jacobian in the middle
///   of an interval and a bound of the points' acceleration. An interval is halved, at most 16
///   times, until the bound is at most 1, is within 0.5 % of the speed in the middle, or can no
///   longer raise the result.
/// @pre There is at least one row, the times ascend strictly, and all numbers are finite.
LimitRatios proveLimits(const std::vector<TimedRow>& rows, int degree,
                        const ConfigurationSpace& space, const JointLimits& limits,
                        const KinematicTree& tree);

}  // namespace corridor
