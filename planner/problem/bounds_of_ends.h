#pragma once

#include <string>

#include "planner/model/bounds.h"
#include "planner/problem/problem.h"

namespace corridor {

/// Enlarges the bounds of a group's position so that they contain the problem's start and goals.
/// Returns whether this changed the bounds.
bool enlargeBounds(Problem& problem, const CoordinateGroup& group);

/// If the group's position in `q` is outside of the group's bounds, returns the reason, such as
/// "outside of the bounds: x = 9 is not in [0, 1]". Otherwise returns "".
std::string whyOutside(const ConfigurationSpace& space, const CoordinateGroup& group,
                       const Configuration& q);

}  // namespace corridor
