#pragma once

#include <vector>

#include "planner/trajectory/limit_bands.h"
#include "planner/trajectory/path_runs.h"
#include "planner/trajectory/reachability.h"
#include "planner/trajectory/time_law.h"

namespace corridor {

/// The fastest law of one run.
struct RunLaw {
  std::vector<LawSegment> segments;  ///< times from 0
  Profile::Failure failure = Profile::Failure::none;
  double lower = 0, upper = 0;  ///< of a failure: the range of ds/dt that is still possible there
  std::size_t piece = 0;        ///< of a failure: the piece where it is
  double tau = 0;               ///< of a failure: τ on that piece
};

/// @param start, end ds/dt at the ends; infinity: any.
RunLaw fastestLaw(const PathView& view, const PathRun& run, const LimitBands& bands, double start,
                  double end, int intervals);

}  // namespace corridor
