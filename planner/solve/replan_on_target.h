#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>

#include "planner/solve/clearance_targets.h"
#include "planner/solve/edge_memory.h"
#include "planner/solve/finish_path.h"

namespace corridor {

class ProblemStateSpace;

/// What limits `replannedOnTarget`.
struct ReplanLimits {
  double longest = 0;           ///< the longest path, in the space's distance
  std::uint64_t mostEdges = 0;  ///< edges after which no further search begins
  double range = HUGE_VAL;      ///< the longest edge of the searches, in the space's distance
  std::function<bool()> stop;   ///< ends searching when it returns true
};

struct ReplannedPath {
  Path path;
  WhyOffTarget why = WhyOffTarget::unknown;  ///< if edges of the path miss a target
};

/// Returns the path, in which edges that miss a clearance target are replaced by edges that keep
/// all targets, where a search finds them. Each stretch of such edges is replaced from the last
/// state before it to the first state behind it that keep the targets. If that fails, wider and
/// wider stretches are searched for, up to the whole path.
///
/// The searches are OMPL's RRTConnect (Kuffner, LaValle 2000), on edges that keep all targets, and
/// among states through which the path is not longer than allowed (Gammell, Srinivasa, Barfoot
/// 2014). What they find is shortened by shortcuts that keep the targets.
///
/// The result depends on the arguments and on OMPL's random numbers only, as long as `stop` returns
/// false. The first and the last state stay.
/// @param free, onTarget remember which edges are free, and which keep all targets.
/// @pre the path is not empty, and its edges are free.
ReplannedPath replannedOnTarget(const std::shared_ptr<ProblemStateSpace>& space,
                                const ClearanceTargets& targets, const Path& path, EdgeMemory& free,
                                EdgeMemory& onTarget, const ReplanLimits& limits);

}  // namespace corridor
