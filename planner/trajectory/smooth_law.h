#pragma once

#include <vector>

#include "planner/trajectory/limit_bands.h"
#include "planner/trajectory/path_runs.h"
#include "planner/trajectory/time_law.h"

namespace corridor {

/// Returns a law of a run with a continuous s̈. The law keeps the limits of velocity, link speed,
/// acceleration and jerk at the ends and in the middle of each of its segments.
///
/// 1. The law s(t) of `segments`, from rest to rest, is averaged over a window w of time:
///      ṡ_w(t) = (s(t) − s(t − w))/w,  s̈_w(t) = (ṡ(t) − ṡ(t − w))/w,  s⃛_w(t) = (s̈(t) − s̈(t − w))/w.
///    The averaged law takes w longer. Its jerk is at most (change of s̈ within w)/w. Up to three
///    windows are tried, and the one with the shortest result is used. This is enough if the limits
///    of jerk are loose.
/// 2. If the result takes more than 1 % longer than `segments`, and there is a limit of jerk,
///    jerkLimitedLaw searches for a faster law.
/// A straight line with a limit of jerk, but without a limit of a link's speed, gets its optimal
/// law instead: at most seven intervals of constant jerk. All times of any other law are multiplied
/// by the smallest factor with which the limits hold at the ends and in the middle of each segment.
/// The result is empty only if no law was found (limits that are too large or too small for
/// doubles), or if `segments` is empty.
std::vector<LawSegment> smoothLaw(const PathView& view, const PathRun& run,
                                  const JointLimits& limits, const KinematicTree& tree,
                                  const std::vector<LawSegment>& segments);

/// Multiplies all times of segments by a factor.
void slowDown(std::vector<LawSegment>& segments, double factor);

}  // namespace corridor
