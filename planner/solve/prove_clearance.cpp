#include "planner/solve/prove_clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace corridor {

namespace {

/// The share of the smallest distance found that is tried first. The true smallest distance is a
/// little less than that at samples; and a proof of nearly all of it would take long.
constexpr double kFirstTry = 0.9;
/// Each further try is for this share of the one before.
constexpr double kNextTry = 0.7;
constexpr int kTries = 8;

/// Returns x, rounded down to two significant digits.
double roundedDownTo2Digits(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 0;
  const double unit = std::pow(10, std::floor(std::log10(x)) - 1);
  const double rounded = std::floor(x / unit) * unit;
  return rounded <= x ? rounded : std::floor(x / unit - 1) * unit;
}

/// Returns the clearance proved for a whole path: the largest of a few that every edge keeps.
double provedClearance(const Checker& checker, const Path& path, double most) {
  double tried = roundedDownTo2Digits(most);
  // The edges before this one keep what is tried. A path of one state has one edge, of no length.
  std::size_t edge = path.size() > 1 ? 1 : 0;
  for (int n = 0; n < kTries && tried > 0; ++n) {
    const PairMargins margins(std::vector(checker.scene().motionPairs().size(), tried));
    while (edge < path.size() &&
           checker.certifyEdge(path[edge > 0 ? edge - 1 : 0], path[edge], margins).verdict ==
               MotionVerdict::free)
      ++edge;
    if (edge >= path.size()) return tried;
    tried = roundedDownTo2Digits(kNextTry * tried);
  }
  return 0;
}

/// Returns a lower bound of the share of an edge on which the targets are kept.
double keptShare(const Checker& checker, const ClearanceTargets& targets, const Configuration& from,
                 const Configuration& to, EdgeMemory& onTarget) {
  if (onTarget.isFree(from, to)) return 1;
  // The edge in both directions. The two parts overlap only if the whole edge is proved.
  const double begin = checker.certifyEdge(from, to, targets.all(), true).certifiedUntil,
               end = checker.certifyEdge(to, from, targets.all(), true).certifiedUntil;
  return std::min(1.0, begin + end);
}

}  // namespace

PathClearance proveClearance(const Checker& checker, const ClearanceTargets& targets,
                             const Path& path, EdgeMemory& onTarget) {
  const ConfigurationSpace& space = checker.space();
  PathClearance result;
  result.smallest = std::numeric_limits<double>::infinity();
  result.ofEnds = targets.ofEnds();
  double length = 0, kept = 0;
  bool all = true;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double part = space.distance(path[i], path[i + 1]),
                 share = keptShare(checker, targets, path[i], path[i + 1], onTarget);
    all = all && share == 1;
    length += part;
    kept += part * share;
  }
  result.shareOnTarget = all ? 1 : kept / length;
  const auto search = [&](std::size_t i, std::size_t k) {
    const auto closest = targets.closestOn(path[i], path[k]);
    if (!closest || !(closest->distance < result.smallest)) return;
    const MotionPair& pair = checker.scene().motionPairs()[closest->pair];
    result.smallest = closest->distance;
    // The last state is the end of the last edge.
    const bool last = i > 0 && i + 1 == path.size();
    result.edge = last ? i - 1 : i;
    result.t = last ? 1 : closest->t;
    result.a = checker.model().bodies[checker.bodyOf(pair.bodyA)].name;
    result.b = checker.model().bodies[checker.bodyOf(pair.bodyB)].name;
  };
  if (all) {
    search(0, 0);
    search(path.size() - 1, path.size() - 1);
    result.proved = roundedDownTo2Digits(targets.least());
    if (path.size() > 1) return result;
  } else {
    for (std::size_t i = 0; i + 1 < path.size(); ++i) search(i, i + 1);
  }
  const double least = std::min(result.smallest, targets.clearance());
  result.proved = provedClearance(
      checker, path, least < targets.clearance() ? kFirstTry * least : targets.clearance());
  return result;
}

}  // namespace corridor
