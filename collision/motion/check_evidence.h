#pragma once

#include <optional>

#include "collision/motion/certify_motion.h"

namespace corridor {

/// What is wrong with the evidence of a motion query.
struct EvidenceFault {
  enum class Kind {
    malformed,  ///< an interval that isn't one of [0, 1] on the grid of 2^-48, or of no pair, or
                ///< that claims less than was asked for; `until` is no time; or options that no
                ///< query takes
    gap,        ///< the pair's intervals don't cover `t`
    refuted,    ///< at `t` the pair is closer than an interval around it claims, or one of the
                ///< two is inside the other, a solid mesh
    unproved,   ///< at `t` the claim holds, but not for all that tube and rounding may do by this
                ///< method, which takes them for the whole of b, not for the part that is close
    workLimit,  ///< out of work (`MotionOptions::workLimit`) at `t`: not proved
    ambiguous,  ///< the motion defines no curve: a half turn, or a way that overflows
    floatingPoint,  ///< the processor is set so that no bound holds (core/floating_point.h)
  };
  Kind kind = Kind::malformed;
  std::size_t pair = 0;
  double t = 0;
};

/// Does the evidence hold? Proves anew that the intervals of every pair cover [0, until], and that
/// all through each of them, for the tube around the motion, the two stay farther apart than the
/// margin and half of what the interval claims beyond it. Solid meshes are tested for what is
/// inside them once, where the first window of an interval from t = 0 is proved.
///
/// Guarantee: where nothing is found wrong and until > 0, no pair comes as close as the margin on
/// [0, until], and none is inside the other there.
///
/// The method is another one, on other trees: the tolerance query on the binary trees, at the
/// middles of ever shorter windows, against an isotropic bound of how far b goes from there. All
/// that it shares with `certifyMotion` is the motion itself and `travelOf`'s isotropic bound. Work
/// is in proportion to the length of the motion over its clearance.
/// @param options  those of the query; `workLimit` bounds the box and triangle tests of the check.
/// @param until  of the answer: `certifiedUntil`.
/// @return none: all holds.
std::optional<EvidenceFault> checkEvidence(MotionSource& motion, std::span<const MotionPair> pairs,
                                           const MotionOptions& options, double until,
                                           const MotionEvidence& evidence, QueryContext& context);

}  // namespace corridor
