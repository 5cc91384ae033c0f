#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// Answers the query of `certifyMotion`, with the same promises, by adaptive bisection (Schwarzer,
/// Saha, Latombe 2005). A time interval of one pair of bodies is proved if the distance at its
/// middle exceeds the sum of the margin and the isotropic motion bound of b about the middle.
/// Otherwise the interval is halved. Pairs are bisected independently of each other.
///
/// Cost: a body that slides along a wall at a distance d needs about length/d intervals. The
/// default method has directional motion bounds and needs only some tens of intervals. Therefore a
/// motion that passes an obstacle closely for a long way may be `undecided` here, because it
/// reaches the work limit.
MotionResult certifyAdaptively(MotionSource& motion, std::span<const MotionPair> pairs,
                               const MotionOptions& options, QueryContext& context);

}  // namespace corridor
