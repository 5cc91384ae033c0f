#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// The reason of a pair that no window about the middle of `window`, however short, proves, though
/// its clearance isn't known to be too small.
/// @param window  without the reserve.
inline UndecidedReason reasonOf(const MotionWindow& window, const Body& b, double tolerance) {
  const double lever = (window.X_AB.m * b.sphereCenter()).norm() + b.sphereRadius();
  const bool sharp = window.fixedError - window.fixedTube +
                         (window.reachError - window.reachTube) * lever <=
                     tolerance / 2;
  return sharp ? UndecidedReason::clearance : UndecidedReason::rounding;
}

/// Counts the query and takes the answer from `run`, unless the edge is ambiguous or the processor
/// is set so that no bound holds.
template <class Run>
MotionResult answered(const MotionSource& motion, bool earliest, QueryContext& context,
                      const Run& run) {
  ++context.counters.edges;
  const auto refused = [](UndecidedReason reason) {
    MotionResult result;
    result.verdict = MotionVerdict::undecided;
    result.reason = reason;
    return result;
  };
  MotionResult result = !standardFloatingPoint() ? refused(UndecidedReason::floatingPoint)
                        : motion.ambiguous()     ? refused(UndecidedReason::ambiguous)
                                                 : run();
  // What methods know of it besides may have gaps: windows that were to be refined later.
  if (!earliest && result.verdict != MotionVerdict::free) {
    result.certifiedUntil = 0;
    result.grazing = false;  // which speaks of all the way from there on
  }
  context.counters.undecided += result.verdict == MotionVerdict::undecided;
  return result;
}

}  // namespace corridor
