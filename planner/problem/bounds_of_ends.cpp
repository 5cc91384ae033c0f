#include "planner/problem/bounds_of_ends.h"

#include <algorithm>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"

namespace corridor {

bool enlargeBounds(Problem& problem, const CoordinateGroup& group) {
  bool enlarged = false;
  const auto include = [&](const Configuration& q) {
    for (std::size_t k = 0; k < dimensionsOf(group); ++k) {
      Coordinate& c = problem.model.space.coordinates()[group.coordinates[k]];
      const double value = q[static_cast<Eigen::Index>(c.first)];
      enlarged |= value < c.lower || value > c.upper;
      c.lower = std::min(c.lower, value);
      c.upper = std::max(c.upper, value);
    }
  };
  include(problem.task.start);
  for (const Configuration& goal : problem.task.goals) include(goal);
  return enlarged;
}

std::string whyOutside(const ConfigurationSpace& space, const CoordinateGroup& group,
                       const Configuration& q) {
  for (std::size_t k = 0; k < dimensionsOf(group); ++k) {
    const Coordinate& c = space.coordinates()[group.coordinates[k]];
    const double value = q[static_cast<Eigen::Index>(c.first)];
    if (!(value < c.lower) && !(value > c.upper)) continue;
    return std::string("outside of the bounds: ") + "xyz"[k] + " = " + shortest(value) +
           " is not in [" + shortest(c.lower) + ", " + shortest(c.upper) + "]";
  }
  return "";
}

}  // namespace corridor
