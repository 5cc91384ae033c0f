#pragma once

#include <cstddef>
#include <vector>

#include "planner/model/limits.h"
#include "planner/robot/configuration_space.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// A row of a trajectory. A rotation has its angular velocity and acceleration (rad/s, rad/s²; in
/// the coordinates of the frame before the joint) in the first three of its four numbers.
struct TimedRow {
  double time = 0;  ///< seconds
  Configuration position, velocity, acceleration;
};

/// The largest ratio of a value to its limit, over all numbers of a Configuration.
struct LimitShare {
  double share = 0;        ///< 1: the limit is reached
  std::size_t number = 0;  ///< of a Configuration; for link speeds: index into JointLimits::links
  double time = 0;         ///< seconds: the begin of the interval between rows
  /// False if the limit is given, but the rows don't determine what it limits (rows_limits.h).
  bool tested = true;
};

/// Upper bounds, valid at every instant.
struct LimitRatios {
  LimitShare velocity, acceleration, jerk, link;
  /// Here `share` is no share, but the largest distance by which a line coordinate leaves its
  /// bounds [lower, upper], in m or rad. 0: none does.
  LimitShare position;
};

/// Returns, for each kind of limit, an upper bound of the ratio of value to limit over the whole
/// curve of the rows. The curve between two rows, in real arithmetic on the stored doubles, is
/// - degree 1: linear in the positions. Only position and velocity are computed. The velocity jumps
///   at each row where the curve has a bend: if there is one, and a limit of acceleration is given,
///   its share is infinite;
/// - degree 3: the cubic Hermite polynomial of positions and velocities;
/// - degree 5: the quintic Hermite polynomial of positions, velocities and accelerations.
/// The derivatives of this curve are polynomials in Bernstein form, so their coefficients bound
/// them (for positions of planar and floating joints: the lengths of the coefficient vectors). An
/// interval is halved until the bound is at most 1, or is within 0.01 % of a value that is
/// attained. All roundings of the coefficients are included (limits_proof.cpp). The cubic's jerk is
/// not bounded: its acceleration jumps at rows.
/// - Rotations are slerps of constant rate between rows (curve.h), so their velocity jumps at rows.
///   The rate is bounded. In place of an acceleration, the change of the rate from one interval to
///   the next is bounded, divided by the mean of the two durations.
/// - Speeds of links: the largest speed of the points of LinkSpeed, from the Jacobian in the middle
///   of an interval and a bound of the points' acceleration. Intervals are halved as for the other
///   limits.
/// @pre at least one row; ascending times; finite numbers.
LimitRatios proveLimits(const std::vector<TimedRow>& rows, int degree,
                        const ConfigurationSpace& space, const JointLimits& limits,
                        const KinematicTree& tree);

}  // namespace corridor
