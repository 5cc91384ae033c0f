#pragma once

#include <optional>

#include "collision/motion/certify_motion.h"

namespace corridor {

/// What is wrong with the evidence of a motion query.
struct EvidenceFault {
  enum class Kind {
    malformed,  ///< an interval that isn't one of [0, 1] on the grid of 2^-48, or of no pair, or
                ///< that claims too little or nothing; or `until` is no time
    gap,        ///< the pair's intervals don't cover `t`
    refuted,    ///< at `t` the pair is closer than an interval around it claims
    unproved,   ///< at `t` the claim holds, but not for all that tube and rounding may do by this
                ///< method, which takes them for the whole of b, not for the part that is close
  };
  Kind kind = Kind::malformed;
  std::size_t pair = 0;
  double t = 0;
};

/// Does the evidence hold? Proves anew that the intervals of every pair cover [0, until], and that
/// in each the two stay farther apart than half of the clearance told, with another method on other
/// trees: the tolerance query on the binary trees, at the middles of ever shorter windows, against
/// an isotropic bound of how far b goes from there. All that it shares with `certifyMotion` is the
/// motion itself and `travelOf`'s isotropic bound.
///
/// It takes work in proportion to the length of the motion over the clearance, without a limit: an
/// audit, not a planner's query. @param until  of the answer: `certifiedUntil`.
/// @return none: all holds.
std::optional<EvidenceFault> checkEvidence(MotionSource& motion, std::span<const MotionPair> pairs,
                                           const MotionOptions& options, double until,
                                           const MotionEvidence& evidence, QueryContext& context);

}  // namespace corridor
