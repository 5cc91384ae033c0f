#pragma once

#include <string>

#include "planner/model/bounds.h"
#include "planner/problem/problem.h"

namespace corridor {

/// Enlarges the bounds of the group so that they contain start and goals. @returns whether they had
/// to be enlarged.
bool enlargeBounds(Problem& problem, const CoordinateGroup& group);

/// Returns why the group's position in `q` is outside of the bounds ("outside of the bounds: x = 9
/// is not in [0, 1]"), or "".
std::string whyOutside(const ConfigurationSpace& space, const CoordinateGroup& group,
                       const Configuration& q);

}  // namespace corridor
