#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "planner/solve/clearance_targets.h"
#include "planner/solve/finish_path.h"

namespace corridor {

/// How far a path stays away from contact.
struct PathClearance {
  /// Every tested pair is proved to keep more than this distance, metres, on the whole path, tube
  /// included. The value is rounded down to three significant digits, and is at most the preferred
  /// clearance. 0: nothing was proved.
  double proved = 0;
  /// The smallest distance found on the path, metres, and where it was found: the pair of bodies,
  /// and the time on the edge from state `edge` (counted from 0) to the next. If `proved` is above
  /// 0, the path's clearance is at least 0.93 times this distance, unless the proof ran into the
  /// tolerance or the tube. If no distance below the preferred clearance was found, `smallest` is
  /// infinite, and `a` and `b` are empty.
  double smallest = 0;
  std::string a, b;
  std::size_t edge = 0;
  double t = 0;
  double leastTarget = 0;  ///< the smallest target of a pair, metres
  /// Why the path misses targets, if `shareOnTarget` is below 1.
  WhyOffTarget why = WhyOffTarget::unknown;
  /// The smallest distance at the start and at the goal, metres; infinite if no pair is closer than
  /// the preferred clearance there.
  double smallestAtEnds = 0;
  /// A lower bound of the fraction of the path's length, in the space's distance, on which every
  /// pair is proved to keep its target (`ClearanceTargets`). 1: on the whole path.
  double shareOnTarget = 0;
};

/// Returns the largest number with three significant digits that is not above x; 0 if x is not
/// above 0 or not finite.
double roundedDownTo3Digits(double x);

/// Proves how far a path stays away from contact.
/// @param onTarget remembers which edges are proved to keep all targets.
/// @pre the states of the path are in bounds, and its edges are free.
PathClearance proveClearance(const Checker& checker, const ClearanceTargets& targets,
                             const Path& path, EdgeMemory& onTarget);

}  // namespace corridor
