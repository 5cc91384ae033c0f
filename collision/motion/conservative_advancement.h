#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// `certifyMotion`'s question and promises, by conservative advancement (Mirtich 1996; for links of
/// a chain Zhang, Redon, Lee, Kim 2007): from t = 0 on, the distance of two bodies at t and a bound
/// of how far any point of b goes from there allow a step over which they can't meet; and so on,
/// until the end, or until the distance has gone.
///
/// The pair that is proved up to the earliest time steps next (Mirtich's queue), so that the first
/// contact is found first, whether it is asked for or not. Close to it steps get shorter by the
/// same share each; what passes by or slides at a distance d takes steps of the order of d, as for
/// `certifyByBisection`.
MotionResult certifyByAdvancement(MotionSource& motion, std::span<const MotionPair> pairs,
                                  const MotionOptions& options, QueryContext& context);

}  // namespace corridor
