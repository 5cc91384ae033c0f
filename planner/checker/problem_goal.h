#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// The problem's start and goals, with normalised quaternions and the angles of circles in [−π, π].
Configuration startOf(const Problem& problem);
std::vector<Configuration> goalsOf(const Problem& problem);

/// Returns whether q is in the goal: in the goal region about one of `goals`; or, if the problem
/// has none, within the .cfg's threshold; or else equal to a goal up to the rounding of its
/// quaternion.
/// @param slack enlarges (> 0) or shrinks (< 0) the region or threshold by this fraction.
bool inGoal(const Problem& problem, const std::vector<Configuration>& goals, const Configuration& q,
            double slack = 0);

/// Returns how far a configuration is outside of the nearest goal region: the sum over the groups
/// of coordinates, in metres and radians, weighted as in distances. @pre the task has a goal
/// region.
double outsideGoalRegion(const Problem& problem, const std::vector<Configuration>& goals,
                         const Configuration& q);

}  // namespace corridor
