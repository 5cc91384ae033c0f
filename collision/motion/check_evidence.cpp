#include "collision/motion/check_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "collision/core/rounding.h"
#include "collision/queries/containment.h"
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

class EvidenceCheck {
 public:
  EvidenceCheck(MotionSource& motion, std::span<const MotionPair> pairs,
                const MotionOptions& options, QueryContext& context)
      : motion_(motion), pairs_(pairs), options_(options), context_(context) {
    const std::uint64_t done = context.counters.work();
    workEnd_ = done + std::min(options.workLimit, std::numeric_limits<std::uint64_t>::max() - done);
  }

  /// Proves the margin and half of what the interval claims beyond it, for all of [t0, t1].
  std::optional<EvidenceFault> faultIn(const FreeInterval& i) {
    const MotionPair& pair = pairs_[i.pair];
    const double h = (i.t1 - i.t0) / 2, middle = i.t0 + h;
    if (context_.counters.work() >= workEnd_) return EvidenceFault{Kind::workLimit, i.pair, middle};
    const MotionWindow window = motion_.window(pair.motion, middle, h);
    const auto closer = [&](double d) {
      return closerThan(pair.a->binaryTree(), {}, pair.b->binaryTree(), window.X_AB, d, context_);
    };
    const PointTravel travel = travelOfBody(*pair.b, window);
    const double beyond = std::max(0.0, i.clearance - options_.margin);
    const double needed =
        roundedUp(options_.margin + roundedUp(beyond / 2) + travel.cap + travel.pad);
    if (needed < HUGE_VAL && !closer(needed)) {
      // Nothing passes through a surface between here and t = 0: what is outside stays so.
      if (i.t0 > 0 || !insideEachOther(*pair.a, {}, *pair.b, window.X_AB, context_))
        return std::nullopt;
      return EvidenceFault{Kind::refuted, i.pair, 0};
    }
    // Shorter windows gain nothing: what is not proved is lost to the pad, or does not hold.
    if (!(travel.cap >= std::max(beyond, options_.tolerance) / 4) ||
        !(i.t0 < middle && middle < i.t1))
      return EvidenceFault{closer(options_.margin + 0.75 * beyond) ? Kind::refuted : Kind::unproved,
                           i.pair, middle};
    const auto first = faultIn({i.pair, i.t0, middle, i.clearance});
    return first ? first : faultIn({i.pair, middle, i.t1, i.clearance});
  }

 private:
  MotionSource& motion_;
  std::span<const MotionPair> pairs_;
  const MotionOptions& options_;
  QueryContext& context_;
  std::uint64_t workEnd_ = 0;
};

/// On the grid of windows: then their middles are exact.
bool isWindow(const FreeInterval& i) {
  const auto onGrid = [](double t) {
    return t >= 0 && t <= 1 && std::ldexp(t, 48) == std::floor(std::ldexp(t, 48));
  };
  return onGrid(i.t0) && onGrid(i.t1) && i.t0 < i.t1;
}

bool areOptions(const MotionOptions& options) {
  const auto finite = [](double x) { return x >= 0 && x < HUGE_VAL; };
  return finite(options.margin) && finite(options.reserve) && finite(options.tolerance) &&
         options.tolerance > 0;
}

}  // namespace

std::optional<EvidenceFault> checkEvidence(MotionSource& motion, std::span<const MotionPair> pairs,
                                           const MotionOptions& options, double until,
                                           const MotionEvidence& evidence, QueryContext& context) {
  if (!standardFloatingPoint()) return EvidenceFault{Kind::floatingPoint, 0, 0};
  if (!areOptions(options) || !(until >= 0 && until <= 1))
    return EvidenceFault{Kind::malformed, 0, until};
  const bool claims = until > 0 || !evidence.free.empty();
  if (claims && motion.ambiguous()) return EvidenceFault{Kind::ambiguous, 0, 0};
  std::vector<FreeInterval> intervals = evidence.free;
  const double least = roundedDown(options.margin + options.reserve);
  for (const FreeInterval& i : intervals)
    if (i.pair >= pairs.size() || !isWindow(i) ||
        !(i.clearance >= least && i.clearance > 0 && i.clearance < HUGE_VAL))
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
  EvidenceCheck check(motion, pairs, options, context);
  for (const FreeInterval& i : intervals)
    if (auto fault = check.faultIn(i)) return fault;
  return std::nullopt;
}

}  // namespace corridor
