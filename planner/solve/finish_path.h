#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "planner/checker/rigid_checker.h"

namespace ompl::geometric {
class PathGeometric;
}
namespace ompl::base {
class SpaceInformation;
}

namespace corridor {

using Path = std::vector<RigidState>;

Path readPath(RigidSpace space, const ompl::geometric::PathGeometric& path);

/// Versions of a path, from the planner's own to the simplest; each may serve if a later one fails.
/// Simplifies until that brings nothing, or `stop` says so; the ends stay.
std::vector<Path> simplifiedVersions(const std::shared_ptr<ompl::base::SpaceInformation>& si,
                                     RigidSpace space, ompl::geometric::PathGeometric& path,
                                     const std::function<bool()>& stop);

/// The path with states inserted on its edges so that no step turns more than 90° (design: «What an
/// edge is»), and repeated states left out.
Path withShortTurns(RigidSpace space, const Path& path);

/// Every state in bounds and every edge certified, whatever was said of them before.
bool certifiedPath(const RigidChecker& checker, const Path& path);

/// Metres along the reference point's way, radians along the rotation.
struct PathLength {
  double metres = 0, radians = 0;
};
PathLength lengthOf(RigidSpace space, const Path& path);

}  // namespace corridor
