#pragma once

#include "collision/hierarchy/body.h"
#include "collision/motion/motion_query.h"
#include "collision/motion/relative_motion.h"

namespace corridor {

/// Returns the reason why a pair of bodies stays undecided in every time interval about the middle
/// of `relative`. The reason is `clearance` in two cases:
/// * The rounding of the pose is at most half of the tolerance.
/// * The gap is at most the tolerance, and the rounding is at most a thousandth of the radius of
///   b's bounding sphere.
/// Otherwise rounding may have caused the small gap, and the reason is `rounding`.
/// @param relative the relative motion, without the clearance slack in its errors.
/// @param gap the distance beyond the margin, measured at the middle, metres.
inline UndecidedReason reasonOf(const RelativeMotion& relative, const Body& b, double gap,
                                double tolerance) {
  const double lever = (relative.X_AB.m * b.sphereCenter()).norm() + b.sphereRadius();
  const double rounding =
      relative.fixedError - relative.fixedTube + (relative.reachError - relative.reachTube) * lever;
  const bool sharp =
      rounding <= tolerance / 2 || (gap <= tolerance && rounding <= 1e-3 * b.sphereRadius());
  return sharp ? UndecidedReason::clearance : UndecidedReason::rounding;
}

/// Returns the answer of `run`; if `earliest` is false and the answer is not `free`, its
/// `certifiedUntil` becomes 0 and its `grazing` false. If the edge is ambiguous, or if no bound
/// holds under the processor's floating-point settings, returns `undecided` without calling `run`.
template <class Run>
MotionResult answered(const MotionSource& motion, bool earliest, const Run& run) {
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
  // Without `earliest`, a method may leave some intervals for later. The proved intervals then have
  // gaps, so no `certifiedUntil` above 0 is proved.
  if (!earliest && result.verdict != MotionVerdict::free) {
    result.certifiedUntil = 0;
    result.grazing = false;  // a statement about the time from `certifiedUntil` on
  }
  return result;
}

/// Counts a motion query: as an edge, or as a state if nothing moves; also as undecided if it is
/// undecided.
inline void count(const MotionSource& motion, const MotionResult& result, Counters& counters) {
  ++(motion.still() ? counters.states : counters.edges);
  counters.undecided += result.verdict == MotionVerdict::undecided;
}

}  // namespace corridor
