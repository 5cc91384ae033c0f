#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// Counts the query, and asks `run` for the answer but of an edge whose way is ambiguous.
template <class Run>
MotionResult answered(const MotionSource& motion, bool earliest, QueryContext& context,
                      const Run& run) {
  ++context.counters.edges;
  MotionResult result;
  if (motion.ambiguous()) {
    result.verdict = MotionVerdict::undecided;
    result.reason = UndecidedReason::ambiguous;
    result.certifiedUntil = 0;
  } else {
    result = run();
  }
  // What methods know of it besides may have gaps: windows that were to be refined later.
  if (!earliest && result.verdict != MotionVerdict::free) {
    result.certifiedUntil = 0;
    result.grazing = false;  // which speaks of all the way from there on
  }
  context.counters.undecided += result.verdict == MotionVerdict::undecided;
  return result;
}

}  // namespace corridor
