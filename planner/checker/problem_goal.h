#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// Quaternions normalised, angles of circles in [−π, π].
Configuration startOf(const Problem& problem);
std::vector<Configuration> goalsOf(const Problem& problem);

/// Is the configuration in the goal: in the region of one of `goals`, or within the .cfg's
/// threshold, or else a goal itself but for the rounding of its quaternion?
/// @param slack of a length or an angle, as a fraction: > 0 forgives, < 0 is strict.
bool inGoal(const Problem& problem, const std::vector<Configuration>& goals, const Configuration& q,
            double slack = 0);

/// How far a configuration is outside of the goal region: of each group of coordinates, in metres
/// and radians, weights as in distances; the least of all goals. @pre problem.goalRegion.
double outsideGoalRegion(const Problem& problem, const std::vector<Configuration>& goals,
                         const Configuration& q);

}  // namespace corridor
