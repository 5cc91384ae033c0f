#include "planner/solve/prove_clearance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "collision/core/rounding.h"

namespace corridor {

namespace {

/// The clearance that is tried to prove, as a fraction of the smallest distance found. So the two
/// differ by less than a tenth. A proof of nearly the whole distance takes many short intervals.
constexpr double kTried = 0.93;
/// If a proof fails where no smaller distance is found, the next clearance that is tried is this
/// fraction of the one before.
constexpr double kNextTry = 0.8;
constexpr int kMostTries = 20;
/// After such a try, this often a clearance between the last two is tried.
constexpr int kRaises = 2;

/// Where a path comes closest, as far as known.
struct Closest {
  double distance = std::numeric_limits<double>::infinity();
  std::size_t edge = 0, pair = 0;
  double t = 0;

  /// @returns whether the place is closer.
  bool note(std::size_t at, const std::optional<ClearanceTargets::Worst>& place) {
    if (!place || !(place->distance > 0) || !(place->distance < distance)) return false;
    *this = {place->distance, at, place->pair, place->t};
    return true;
  }
};

/// Proves a clearance of nearly the smallest distance. Where the proof fails, the path may come
/// closer than at any sample, so that place is searched, too.
/// @returns a clearance that every edge is proved to keep; 0 if no proof is found, or none above
/// `least`.
/// @param most the first clearance that is tried.
double provedClearance(const Checker& checker, const ClearanceTargets& targets, const Path& path,
                       double most, double least, Closest& closest) {
  const std::size_t edges = std::max<std::size_t>(path.size() - 1, 1);
  // Proves edges from `edge` on. Returns whether all are proved; if not, `edge` is the first that
  // is not, and `failed` the answer.
  MotionResult failed;
  const auto proves = [&](double clearance, std::size_t& edge) {
    const PairMargins margins(std::vector(checker.scene().motionPairs().size(), clearance));
    for (; edge < edges; ++edge) {
      // A path of one state has one edge, of length 0.
      failed = checker.certifyEdge(path[edge], path[std::min(edge + 1, path.size() - 1)],
                                   {.margins = &margins});
      if (failed.verdict != MotionVerdict::free) return false;
    }
    return true;
  };
  double tried = most, refused = 0;
  // All edges before this one are proved to keep the clearance that is tried.
  std::size_t edge = 0;
  int n = 0;
  for (; n < kMostTries && tried > least && !proves(tried, edge); ++n) {
    const Configuration &from = path[edge], &to = path[std::min(edge + 1, path.size() - 1)];
    const bool isCloser =
        failed.time >= 0 && closest.note(edge, targets.closestNear(from, to, failed.time));
    refused = isCloser ? 0 : tried;
    tried = isCloser ? std::min(tried, kTried * closest.distance) : kNextTry * tried;
  }
  if (n == kMostTries || !(tried > least)) return 0;
  for (int i = 0; i < kRaises && refused > 0; ++i) {
    const double between = (tried + refused) / 2;
    std::size_t first = 0;
    (proves(between, first) ? tried : refused) = between;
  }
  return tried;
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
  // A sum that is rounded to 1 may leave a gap between the two parts.
  if (end >= sumRoundedUp(1, -begin)) return 1;
  return std::min(begin + end, std::nextafter(1.0, 0.0));
}

}  // namespace

double roundedDownTo3Digits(double x) {
  if (!(x > 0) || !std::isfinite(x)) return 0;
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", x);  // "1.23e-03"
  if (const double nearest = std::strtod(text, nullptr); nearest <= x) return nearest;
  int digits = 100 * (text[0] - '0') + 10 * (text[2] - '0') + (text[3] - '0') - 1,
      exponent = std::atoi(text + 5) - 2;
  if (digits == 99) {  // the number below 1.00·10^n is 9.99·10^(n - 1)
    digits = 999;
    --exponent;
  }
  std::snprintf(text, sizeof text, "%de%d", digits, exponent);
  return std::strtod(text, nullptr);
}

PathClearance proveClearance(const Checker& checker, const ClearanceTargets& targets,
                             const Path& path, EdgeMemory& onTarget) {
  const ConfigurationSpace& space = checker.space();
  PathClearance result;
  result.smallestAtEnds = targets.smallestAtEnds();
  result.leastTarget = targets.least();
  Closest closest;
  double length = 0, kept = 0;
  bool all = path.size() > 1;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double part = space.distance(path[i], path[i + 1]),
                 share = keptShare(checker, targets, path[i], path[i + 1], onTarget);
    if (share < 1) {
      all = false;
      closest.note(i, targets.missedOn(path[i], path[i + 1]));
    }
    length += part;
    kept += part * share;
  }
  result.shareOnTarget = all ? 1 : length > 0 ? kept / length : 0;
  // If every pair keeps its target, and all targets are equal to the clearance, no pair is closer
  // than the clearance, so there is nothing to search for.
  if (!all || targets.least() < targets.clearance())
    for (std::size_t i = 0; i + 1 < std::max<std::size_t>(path.size(), 2); ++i)
      closest.note(i, targets.closestOn(path[i], path[std::min(i + 1, path.size() - 1)]));
  const double proved = all ? targets.least() : 0, tried = closest.distance < targets.clearance()
                                                               ? kTried * closest.distance
                                                           : all ? targets.clearance()
                                                                 : kTried * targets.clearance();
  result.proved = proved;
  if (tried > proved)
    result.proved =
        std::max(proved, provedClearance(checker, targets, path, tried, proved, closest));
  result.proved = roundedDownTo3Digits(result.proved);
  if (path.size() == 1) result.shareOnTarget = result.proved >= targets.least() ? 1 : 0;
  result.smallest = closest.distance;
  if (std::isinf(closest.distance)) return result;
  const MotionPair& pair = checker.scene().motionPairs()[closest.pair];
  result.edge = closest.edge;
  result.t = closest.t;
  result.a = checker.model().bodies[checker.bodyOf(pair.bodyA)].name;
  result.b = checker.model().bodies[checker.bodyOf(pair.bodyB)].name;
  return result;
}

}  // namespace corridor
