#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// Answers the query of `certifyMotion`, with the same promises, by conservative advancement
/// (Mirtich 1996; for links of a chain Zhang, Redon, Lee, Kim 2007). The search starts at t = 0.
/// The distance of two bodies at t, and a bound of their relative motion after t, give a time step
/// in which the bodies cannot meet. Steps are repeated until the end of the motion, or until the
/// distance is too small for a step.
///
/// The next step is for the pair whose proof has got least far in time (Mirtich's queue). Therefore
/// the first contact is found first, whether it is requested or not. Close to a contact, each step
/// is shorter than the one before by the same factor. A body that passes an obstacle, or slides
/// along it, at a distance d needs steps whose length is of the order of d, as in
/// `certifyAdaptively`.
MotionResult certifyByAdvancement(MotionSource& motion, std::span<const MotionPair> pairs,
                                  const MotionOptions& options, QueryContext& context);

}  // namespace corridor
