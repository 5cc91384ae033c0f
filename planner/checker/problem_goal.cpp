#include "planner/checker/problem_goal.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/rounding.h"
#include "planner/checker/group_difference.h"
#include "planner/robot/difference.h"

namespace corridor {
namespace {

bool inRegion(const Problem& problem, const Configuration& goal, const Configuration& q,
              double grow) {
  // Let u = kUnit. Each component of a normalised quaternion has an error below 4u. So the angle
  // between two normalised quaternions has an error below 32u. Its computation adds at most another
  // 32u.
  const double same = 64 * kUnit;
  const GoalRegion& region = *problem.task.goalRegion;
  for (const CoordinateGroup& group : problem.model.space.groups()) {
    if (group.kind == CoordinateGroup::Kind::joints) {
      for (const std::size_t c : group.coordinates)
        if (!(differenceOf(problem.model.space.coordinates()[c], goal, q) <=
              std::max(region.joint * grow,
                       problem.model.space.coordinates()[c].kind == Coordinate::Kind::circle ? same
                                                                                             : 0)))
          return false;
    } else if (!(positionDifference(problem.model.space, group, goal, q) <=
                 region.position * grow) ||
               !(rotationDifference(problem.model.space, group, goal, q) <=
                 std::max(region.angle * grow, same))) {
      return false;
    }
  }
  return true;
}

double outside(const Problem& problem, const Configuration& goal, const Configuration& q) {
  const std::vector<Coordinate>& coordinates = problem.model.space.coordinates();
  const GoalRegion& region = *problem.task.goalRegion;
  double sum = 0;
  for (const CoordinateGroup& group : problem.model.space.groups()) {
    if (group.kind == CoordinateGroup::Kind::joints) {
      for (const std::size_t c : group.coordinates)
        sum += coordinates[c].weight *
               std::max(differenceOf(coordinates[c], goal, q) - region.joint, 0.0);
    } else {
      sum +=
          coordinates[group.coordinates.front()].weight *
          std::max(positionDifference(problem.model.space, group, goal, q) - region.position, 0.0);
      sum += coordinates[group.coordinates.back()].weight *
             std::max(rotationDifference(problem.model.space, group, goal, q) - region.angle, 0.0);
    }
  }
  return sum;
}

}  // namespace

Configuration startOf(const Problem& problem) {
  Configuration q = problem.task.start;
  problem.model.space.normalise(q);
  return q;
}

std::vector<Configuration> goalsOf(const Problem& problem) {
  std::vector<Configuration> goals = problem.task.goals;
  for (Configuration& goal : goals) problem.model.space.normalise(goal);
  return goals;
}

bool inGoal(const Problem& problem, const std::vector<Configuration>& goals, const Configuration& q,
            double slack) {
  return std::any_of(goals.begin(), goals.end(), [&](const Configuration& goal) {
    if (problem.task.goalRegion) return inRegion(problem, goal, q, 1 + slack);
    if (problem.task.goalThreshold)
      return problem.model.space.distance(goal, q) <= *problem.task.goalThreshold * (1 + slack);
    return problem.model.space.equal(goal, q);
  });
}

double distanceToGoalRegion(const Problem& problem, const std::vector<Configuration>& goals,
                            const Configuration& q) {
  double least = std::numeric_limits<double>::infinity();
  for (const Configuration& goal : goals) least = std::min(least, outside(problem, goal, q));
  return least;
}

}  // namespace corridor
