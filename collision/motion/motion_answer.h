#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// Why a pair of bodies stays undecided in every window about the middle of `window`: its clearance
/// is small, or the rounding of its pose takes more than half of the tolerance from a gap above it,
/// or more than a thousandth of the body, so that the gap says nothing.
/// @param window  without the reserve. @param gap  as measured at the middle, metres.
inline UndecidedReason reasonOf(const MotionWindow& window, const Body& b, double gap,
                                double tolerance) {
  const double lever = (window.X_AB.m * b.sphereCenter()).norm() + b.sphereRadius();
  const double rounding =
      window.fixedError - window.fixedTube + (window.reachError - window.reachTube) * lever;
  const bool sharp =
      rounding <= tolerance / 2 || (gap <= tolerance && rounding <= 1e-3 * b.sphereRadius());
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
    result.certifiedUntil = 0;
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
