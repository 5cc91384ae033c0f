#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/solve/edge_memory.h"

namespace ompl::base {
class SpaceInformation;
}
namespace ompl::geometric {
class PathGeometric;
}

namespace corridor {

using Path = std::vector<Configuration>;

/// Returns the configurations of an OMPL path. @pre the path's space is a ProblemStateSpace.
Path configurationsOf(const ompl::geometric::PathGeometric& path);

/// Shortens a path by OMPL's `PathSimplifier::simplify`, which uses random numbers and its own edge
/// tests. This function is the baseline for `simplifiedVersions` (simplify_path.h). Simplifying
/// ends when OMPL finds no more improvement, or soon after `stop` returns true. The first and the
/// last state stay.
void simplifyByOmpl(const std::shared_ptr<ompl::base::SpaceInformation>& si,
                    ompl::geometric::PathGeometric& path, const std::function<bool()>& stop);

/// Returns the path without edges of length 0, except that the last edge may have length 0. States
/// are inserted on its edges, so that no circle or rotation turns by more than 90° between two
/// states. Every edge is then far from a half turn, whose direction is not defined.
Path withShortTurns(const ConfigurationSpace& space, const Path& path);

/// Tests the path again, by the checker's certified method, whatever method the planner used.
/// Returns whether all states are in bounds and all edges are certified.
/// @param proved if not null: edges that this memory knows to be free are not tested again.
/// @pre the certified method has proved all edges that `proved` knows to be free, with this
/// checker.
bool isCertified(const Checker& checker, const Path& path, const EdgeMemory* proved = nullptr);

/// The length of a path, summed over its edges. `metres`: |Δp| of planar and floating joints, and
/// |Δq| of prismatic joints. `radians`: the rotation angles of planar and floating joints, and |Δq|
/// of revolute and continuous joints.
struct PathLength {
  double metres = 0, radians = 0;
};
PathLength lengthOf(const ConfigurationSpace& space, const Path& path);
/// Returns the length of a path in the space's distance.
double distanceAlong(const ConfigurationSpace& space, const Path& path);

/// Returns words for a message about a length. They say over which parts of the space the length of
/// an edge is summed, such as "sum over the joints". Returns "" if the space has only one joint or
/// body.
std::string summands(const ConfigurationSpace& space);

}  // namespace corridor
