#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// Counts the query, and asks `run` for the answer but of an edge whose way is ambiguous.
template <class Run>
MotionResult answered(const MotionSource& motion, QueryContext& context, const Run& run) {
  ++context.counters.edges;
  MotionResult result;
  if (motion.ambiguous()) {
    result.verdict = MotionVerdict::undecided;
    result.reason = UndecidedReason::ambiguous;
    result.certifiedUntil = 0;
  } else {
    result = run();
  }
  context.counters.undecided += result.verdict == MotionVerdict::undecided;
  return result;
}

}  // namespace corridor
