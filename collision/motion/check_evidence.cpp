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

/// Proves half of the claim for all of [t0, t1], or tells where it can't be.
std::optional<EvidenceFault> faultIn(MotionSource& motion, std::span<const MotionPair> pairs,
                                     const FreeInterval& i, QueryContext& context) {
  const MotionPair& pair = pairs[i.pair];
  const double h = (i.t1 - i.t0) / 2, middle = i.t0 + h;
  const MotionWindow window = motion.window(pair.motion, middle, h);
  const auto closer = [&](double d) {
    return closerThan(pair.a->binaryTree(), {}, pair.b->binaryTree(), window.X_AB, d, context);
  };
  const PointTravel travel = travelOfBody(*pair.b, window);
  const double needed = roundedUp(i.clearance / 2 + travel.cap + travel.pad);
  if (needed < HUGE_VAL && !closer(needed)) return std::nullopt;
  // Nothing is gained by shorter windows: what is not proved is lost to the pad, or not so.
  if (!(travel.cap >= i.clearance / 4) || !(i.t0 < middle && middle < i.t1))
    return EvidenceFault{closer(0.75 * i.clearance) ? Kind::refuted : Kind::unproved, i.pair,
                         middle};
  const auto first = faultIn(motion, pairs, {i.pair, i.t0, middle, i.clearance}, context);
  return first ? first : faultIn(motion, pairs, {i.pair, middle, i.t1, i.clearance}, context);
}

/// On the grid of windows: then their middles are exact.
bool isWindow(const FreeInterval& i) {
  const auto onGrid = [](double t) {
    return t >= 0 && t <= 1 && std::ldexp(t, 48) == std::floor(std::ldexp(t, 48));
  };
  return onGrid(i.t0) && onGrid(i.t1) && i.t0 < i.t1;
}

}  // namespace

std::optional<EvidenceFault> checkEvidence(MotionSource& motion, std::span<const MotionPair> pairs,
                                           const MotionOptions& options, double until,
                                           const MotionEvidence& evidence, QueryContext& context) {
  std::vector<FreeInterval> intervals = evidence.free;
  const double least = options.margin + options.reserve;
  if (!(until >= 0 && until <= 1)) return EvidenceFault{Kind::malformed, 0, until};
  for (const FreeInterval& i : intervals)
    if (i.pair >= pairs.size() || !isWindow(i) ||
        !(i.clearance >= roundedDown(least) && i.clearance > 0 && i.clearance < HUGE_VAL))
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
    if (auto fault = faultIn(motion, pairs, i, context)) return fault;
  return std::nullopt;
}

}  // namespace corridor
