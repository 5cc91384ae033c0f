#include "collision/motion/check_evidence.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "collision/core/rounding.h"
#include "collision/queries/distance.h"

namespace corridor {
namespace {

using Kind = EvidenceFault::Kind;

/// How far b's points go from where they are at the window's middle, tube and rounding included.
PointTravel travelOfBody(const Body& b, const MotionWindow& window) {
  const Vec3 y = window.X_AB.m * b.sphereCenter();
  // The sphere's centre is off by less than 8u of its terms a coordinate: 16u as a length.
  const double terms = y.cwiseAbs().sum() + window.X_AB.t.cwiseAbs().sum();
  return travelOf(window, y + window.X_AB.t, roundedUp(b.sphereRadius() + 16 * kUnit * terms));
}

/// Proves the claim for all of [t0, t1], or finds a place where it can't be proved.
std::optional<double> refuted(MotionSource& motion, const MotionPair& pair, double t0, double t1,
                              double claim, QueryContext& context) {
  const double h = (t1 - t0) / 2, middle = t0 + h;
  const MotionWindow window = motion.window(pair.motion, middle, h);
  const PointTravel travel = travelOfBody(*pair.b, window);
  const double needed = roundedUp(claim / 2 + travel.cap + travel.pad);
  if (!closerThan(pair.a->binaryTree(), {}, pair.b->binaryTree(), window.X_AB, needed, context))
    return {};
  // Were the claim true, the distance at the middle would exceed claim + pad.
  if (travel.cap < claim / 4) return middle;
  const auto first = refuted(motion, pair, t0, middle, claim, context);
  return first ? first : refuted(motion, pair, middle, t1, claim, context);
}

/// Dyadic, as windows are: then their middles are exact.
bool isWindow(const FreeInterval& i) {
  const double h = (i.t1 - i.t0) / 2, middle = i.t0 + h;
  return i.t0 >= 0 && i.t1 <= 1 && h > 0 && middle - h == i.t0 && middle + h == i.t1;
}

}  // namespace

std::optional<EvidenceFault> checkEvidence(MotionSource& motion, std::span<const MotionPair> pairs,
                                           const MotionOptions& options, double until,
                                           const MotionEvidence& evidence, QueryContext& context) {
  std::vector<FreeInterval> intervals = evidence.free;
  const double least = options.margin + options.reserve;
  for (const FreeInterval& i : intervals)
    if (i.pair >= pairs.size() || !isWindow(i) || !(i.clearance >= roundedDown(least)))
      return EvidenceFault{Kind::malformed, i.pair, i.t0};
  std::sort(intervals.begin(), intervals.end(), [](const FreeInterval& x, const FreeInterval& y) {
    return x.pair != y.pair ? x.pair < y.pair : x.t0 < y.t0;
  });
  auto next = intervals.begin();
  for (std::size_t k = 0; k < pairs.size() && until > 0; ++k) {
    double covered = 0;
    for (; next != intervals.end() && next->pair == k; ++next)
      if (next->t0 <= covered) covered = std::max(covered, next->t1);
    if (covered < until) return EvidenceFault{Kind::gap, k, covered};
  }
  for (const FreeInterval& i : intervals)
    if (const auto t = refuted(motion, pairs[i.pair], i.t0, i.t1, i.clearance, context))
      return EvidenceFault{Kind::refuted, i.pair, *t};
  return std::nullopt;
}

}  // namespace corridor
