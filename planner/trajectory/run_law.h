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
  double lower = 0, upper = 0;  ///< for a failure: ds/dt for `lower` and `upper` of Profile
  std::size_t piece = 0;        ///< for a failure: the piece of the path where it occurs
  double tau = 0;               ///< for a failure: τ on that piece
};

/// Returns the fastest law of a run on a grid, by reachability analysis, or a failure without
/// segments.
/// @param start, end ds/dt at the ends of the run; infinity: any rate.
/// @param intervals the number of grid intervals before refinement.
RunLaw fastestLaw(const PathView& view, const PathRun& run, const LimitBands& bands, double start,
                  double end, int intervals);

}  // namespace corridor
