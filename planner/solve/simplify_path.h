#pragma once

#include <functional>
#include <vector>

#include "planner/solve/edge_memory.h"
#include "planner/solve/finish_path.h"

namespace corridor {

/// Shortens a path by shortcuts. A shortcut is an edge between two points of the path, if it is
/// shorter than the part of the path between them. Lengths are distances of the space.
///
/// Simplifying spends its time on edge tests. So no edge is tested twice, and few edges are tested:
/// 1. From the whole path downwards, a part of the path is replaced by one edge if this edge is
///    free. Otherwise both halves of the part are tried.
/// 2. Up to three rounds try shortcuts over halves, quarters, … of the path, and then shortcuts
///    across its corners. The corner with the largest gain is always next. At first, both ends of a
///    shortcut across a corner are as far from the corner as the nearer of its two neighbours. Each
///    time the shortcut is not free, this distance is halved, up to five times. A shortcut that
///    gains less than a thousandth of the length is not tried.
/// 3. States are removed where the edge between their neighbours is free. (This is also done after
///    step 1.)
///
/// Returns the versions of the path, from the path itself to the shortest, so that an earlier
/// version can be used if a later one can't be certified. The first and the last state stay. The
/// result depends on the arguments only, as long as `stop` returns false; no random numbers are
/// used. If `stop` returns true, no further edge is tested.
/// @pre the path is not empty, and its edges are free.
std::vector<Path> simplifiedVersions(const ConfigurationSpace& space, const Path& path,
                                     EdgeMemory& edges, const std::function<bool()>& stop);
inline std::vector<Path> simplifiedVersions(const ConfigurationSpace& space, const Path& path,
                                            const EdgeTest& isFree,
                                            const std::function<bool()>& stop) {
  EdgeMemory edges(isFree);
  return simplifiedVersions(space, path, edges, stop);
}

}  // namespace corridor
