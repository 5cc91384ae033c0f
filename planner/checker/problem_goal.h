#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// Return the problem's start and goals, with normalised quaternions, and with the angles of
/// circles in [−π, π].
Configuration startOf(const Problem& problem);
std::vector<Configuration> goalsOf(const Problem& problem);

/// Returns whether q is in the goal. If the task has a goal region, q must be in the region about
/// one of `goals`. If it has a threshold (`.cfg`), q must be at most that distance from a goal.
/// Otherwise q must be equal to a goal (`ConfigurationSpace::equal`).
/// @param slack enlarges (> 0) or shrinks (< 0) the region or threshold by this fraction.
bool inGoal(const Problem& problem, const std::vector<Configuration>& goals, const Configuration& q,
            double slack = 0);

/// Returns how far a configuration is outside of the nearest goal region; 0 inside. It is a sum
/// over single joints, positions and rotation angles: the part of each difference that is beyond
/// the region, in metres or radians, times the weight of the coordinate.
/// @pre the task has a goal region.
double distanceToGoalRegion(const Problem& problem, const std::vector<Configuration>& goals,
                            const Configuration& q);

}  // namespace corridor
