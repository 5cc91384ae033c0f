#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// Return the start (`startOf`) and the goals (`goalsOf`) of the problem, with normalised
/// quaternions, and with the angles of circles in [−π, π].
Configuration startOf(const Problem& problem);
std::vector<Configuration> goalsOf(const Problem& problem);

/// Returns whether q is in the goal. If the task has a goal region, q must be in the region about
/// one of `goals`. If it has a threshold (`.cfg`), q must be at most that distance from a goal.
/// Otherwise q must be equal to a goal (`ConfigurationSpace::equal`).
/// @param goals as `goalsOf` returns them.
/// @param slack enlarges (> 0) or shrinks (< 0) the region or threshold by this fraction. It has no
/// effect if the task has neither.
bool inGoal(const Problem& problem, const std::vector<Configuration>& goals, const Configuration& q,
            double slack = 0);

/// Returns how far a configuration is outside of the nearest goal region, or 0 inside of a region.
/// The result is a sum over single joints, positions and rotation angles. Each term is the part of
/// the difference that is beyond the region, in metres or radians, times the weight of the
/// coordinate.
/// @pre the task has a goal region.
double distanceToGoalRegion(const Problem& problem, const std::vector<Configuration>& goals,
                            const Configuration& q);

}  // namespace corridor
