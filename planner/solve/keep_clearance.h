#pragma once

#include <functional>

#include "planner/problem/problem.h"
#include "planner/solve/clearance_targets.h"
#include "planner/solve/simplify_path.h"

namespace corridor {

/// Returns the clearance that the path of a problem should keep, metres: `prefer.clearance`, or
/// else 5 mm for robots with joints, and 0 for rigid bodies; at most 1e6. Always 0 if the problem
/// has a margin, if its path is not simplified by Corridor, if edges are sampled, or if the planner
/// itself maximises the clearance.
double preferredClearance(const Problem& problem);

/// Returns the path moved away from obstacles, so that the pairs of bodies keep their targets where
/// possible. The result is not longer than `longest`, in the space's distance.
///
/// The share of an edge is the smallest share of a pair on the edge (`ClearanceTargets`): 1 if
/// every pair is proved to keep its target, else the smallest share found at samples. Edges are
/// changed in the order of their shares, the smallest first. A state is inserted at the time of the
/// smallest share, or an end of the edge near this time is moved, so that the pairs are farther
/// apart there (`ClearanceTargets::movedApart`). The change is taken if all of these hold:
/// * The new edges are free.
/// * Each new edge keeps all targets; or its share is at least 0.98, or larger by at least 0.05
///   than the smallest share of the edges that are replaced.
/// * The path is not longer than `longest`.
/// If a change is not taken, a later try on this edge moves the state half as far, and a third try
/// a quarter as far. At most 60 tries are made; a try at an end of an edge may include a second
/// change, the inserted state. At the end, a state next to a changed edge is removed if the edge
/// between its neighbours keeps all targets.
///
/// The first and the last state stay. The result depends on the arguments only, as long as `stop`
/// returns false.
/// @param edges remembers which edges are free.
/// @param onTarget remembers which edges are proved to keep all targets.
/// @pre the path is not empty, and its edges are free.
Path withClearance(const ClearanceTargets& targets, const ConfigurationSpace& space,
                   const Path& path, double longest, EdgeMemory& edges, EdgeMemory& onTarget,
                   const std::function<bool()>& stop);

}  // namespace corridor
