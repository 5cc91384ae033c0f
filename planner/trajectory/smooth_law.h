#pragma once

#include <vector>

#include "planner/trajectory/limit_bands.h"
#include "planner/trajectory/path_runs.h"
#include "planner/trajectory/time_law.h"

namespace corridor {

/// Returns a law of a run with a continuous s̈, which keeps the limits of velocity, acceleration and
/// jerk at the ends and middles of its segments.
///
/// The law s(t) of `segments`, from rest to rest, is averaged over a window w of time:
///   ṡ_w(t) = (s(t) − s(t − w))/w,  s̈_w(t) = (ṡ(t) − ṡ(t − w))/w,  s⃛_w(t) = (s̈(t) − s̈(t − w))/w.
/// It takes w longer. Its s̈ is an average of s̈, so its jerk is at most the jump of s̈ by w. Then all
/// times are multiplied by the factor with which the limits hold. Of 24 windows, the one with the
/// shortest time is used.
std::vector<LawSegment> smoothLaw(const PathView& view, const PathRun& run,
                                  const JointLimits& limits, const KinematicTree& tree,
                                  const std::vector<LawSegment>& segments);

/// Multiplies all times of segments by a factor.
void slowDown(std::vector<LawSegment>& segments, double factor);

}  // namespace corridor
