#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// Answers the query of `certifyMotion`, with the same promises, by conservative advancement
/// (Mirtich 1996; for links of a chain Zhang, Redon, Lee, Kim 2007). Starting at t = 0, the
/// distance of two bodies at t and a bound of b's motion after t give a step during which the
/// bodies cannot meet. Steps are repeated until the end, or until no distance is left.
///
/// The pair that is proved up to the earliest time makes the next step (Mirtich's queue). The first
/// contact is therefore found first, whether it is requested or not. Close to a contact, the steps
/// get shorter by the same factor each. A body that slides along or passes an obstacle at a
/// distance d needs steps of the order of d, as in `certifyByBisection`.
MotionResult certifyByAdvancement(MotionSource& motion, std::span<const MotionPair> pairs,
                                  const MotionOptions& options, QueryContext& context);

}  // namespace corridor
