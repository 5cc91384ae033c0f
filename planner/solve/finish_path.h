#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "planner/checker/checker.h"

namespace ompl::geometric {
class PathGeometric;
}
namespace ompl::base {
class SpaceInformation;
}

namespace corridor {

using Path = std::vector<Configuration>;

/// @pre the states are a ProblemStateSpace's, and that is the path's space.
Path readPath(const ompl::geometric::PathGeometric& path);

/// Versions of a path, from the planner's own to the simplest; each may serve if a later one fails.
/// Simplifies until that brings nothing, or `stop` says so; the ends stay.
std::vector<Path> simplifiedVersions(const std::shared_ptr<ompl::base::SpaceInformation>& si,
                                     ompl::geometric::PathGeometric& path,
                                     const std::function<bool()>& stop);

/// The path with states inserted on its edges so that in no step a circle or a rotation turns more
/// than 90° (design: «What an edge is»), and repeated states left out.
Path withShortTurns(const ConfigurationSpace& space, const Path& path);

/// Every state in bounds and every edge certified, whatever was said of them before.
bool certifiedPath(const Checker& checker, const Path& path);

/// Metres: along the ways of planar and floating joints, and what sliding joints do. Radians: along
/// their rotations, and what turning joints do.
struct PathLength {
  double metres = 0, radians = 0;
};
PathLength lengthOf(const ConfigurationSpace& space, const Path& path);

}  // namespace corridor
