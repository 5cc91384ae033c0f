#include "planner/solve/prove_clearance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

namespace corridor {

namespace {

/// The first clearance that is tried, as a fraction of the smallest distance found at samples. The
/// true smallest distance is a little smaller than at samples. A proof of nearly the whole distance
/// takes many short intervals.
constexpr double kFirstTry = 0.9;
/// Each further clearance that is tried is this fraction of the clearance before.
constexpr double kNextTry = 0.8;
constexpr int kMostTries = 10;

/// Tries a few clearances from `most` downwards. Returns the first of them that every edge of a
/// path is proved to keep. Returns 0 if the proof fails for all clearances that are tried: at most
/// kMostTries, all above `least`.
double provedClearance(const Checker& checker, const Path& path, double most, double least) {
  double tried = roundedDownTo2Digits(most);
  // All edges before this one are proved to keep the clearance that is tried. A path of one state
  // has one edge, of length 0.
  std::size_t edge = path.size() > 1 ? 1 : 0;
  for (int n = 0; n < kMostTries && tried > least; ++n) {
    const PairMargins margins(std::vector(checker.scene().motionPairs().size(), tried));
    while (edge < path.size() &&
           checker.certifyEdge(path[edge > 0 ? edge - 1 : 0], path[edge], {.margins = &margins})
                   .verdict == MotionVerdict::free)
      ++edge;
    if (edge >= path.size()) return tried;
    tried = roundedDownTo2Digits(kNextTry * tried);
  }
  return 0;
}

/// Returns a lower bound of the fraction of an edge on which the targets are kept.
double keptShare(const Checker& checker, const ClearanceTargets& targets, const Configuration& from,
                 const Configuration& to, EdgeMemory& onTarget) {
  if (onTarget.isFree(from, to)) return 1;
  // The edge is proved from both of its ends. The two proved parts overlap only if the whole edge
  // is proved.
  const double begin = checker.certifyEdge(from, to, {.earliest = true, .margins = &targets.all()})
                           .certifiedUntil,
               end = checker.certifyEdge(to, from, {.earliest = true, .margins = &targets.all()})
                         .certifiedUntil;
  return std::min(1.0, begin + end);
}

}  // namespace

double roundedDownTo2Digits(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 0;
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", x);  // "1.2e-03"
  if (const double nearest = std::strtod(text, nullptr); nearest <= x) return nearest;
  int digits = 10 * (text[0] - '0') + (text[2] - '0') - 1, exponent = std::atoi(text + 4) - 1;
  if (digits == 9) {  // the number below 1.0·10^n is 9.9·10^(n - 1)
    digits = 99;
    --exponent;
  }
  std::snprintf(text, sizeof text, "%de%d", digits, exponent);
  return std::strtod(text, nullptr);
}

PathClearance proveClearance(const Checker& checker, const ClearanceTargets& targets,
                             const Path& path, EdgeMemory& onTarget) {
  const ConfigurationSpace& space = checker.space();
  PathClearance result;
  result.smallest = std::numeric_limits<double>::infinity();
  result.smallestAtEnds = targets.smallestAtEnds();
  const auto note = [&](std::size_t edge, const std::optional<ClearanceTargets::Worst>& place) {
    if (!place || !(place->distance > 0) || !(place->distance < result.smallest)) return;
    const MotionPair& pair = checker.scene().motionPairs()[place->pair];
    result.smallest = place->distance;
    result.edge = edge;
    result.t = place->t;
    result.a = checker.model().bodies[checker.bodyOf(pair.bodyA)].name;
    result.b = checker.model().bodies[checker.bodyOf(pair.bodyB)].name;
  };
  double length = 0, kept = 0;
  bool all = path.size() > 1;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double part = space.distance(path[i], path[i + 1]),
                 share = keptShare(checker, targets, path[i], path[i + 1], onTarget);
    if (share < 1) {
      all = false;
      note(i, targets.missedOn(path[i], path[i + 1]));
    }
    length += part;
    kept += part * share;
  }
  result.shareOnTarget = all ? 1 : length > 0 ? kept / length : 0;
  // If every pair keeps its target, and all targets are equal to the clearance, no pair is closer
  // than the clearance, so there is nothing to search for.
  if (!all || targets.least() < targets.clearance())
    for (std::size_t i = 0; i + 1 < std::max<std::size_t>(path.size(), 2); ++i)
      note(i, targets.closestOn(path[i], path[std::min(i + 1, path.size() - 1)]));
  const double proved = all ? roundedDownTo2Digits(targets.least()) : 0,
               tried = result.smallest < targets.clearance() ? kFirstTry * result.smallest
                       : all                                 ? targets.clearance()
                                                             : kFirstTry * targets.clearance();
  result.proved = proved;
  if (roundedDownTo2Digits(tried) > proved)
    result.proved = std::max(proved, provedClearance(checker, path, tried, proved));
  if (path.size() == 1) result.shareOnTarget = result.proved >= targets.least() ? 1 : 0;
  return result;
}

}  // namespace corridor
