#pragma once

#include "collision/motion/certify_motion.h"

namespace corridor {

/// `certifyMotion`'s question and promises, by the adaptive bisection of Schwarzer, Saha, Latombe
/// 2005: a window of time of one pair of bodies is proved when the distance at its middle exceeds
/// what any point of b travels from there, whatever the direction; else it is halved. Pairs are
/// bisected independently.
///
/// What it costs: a body that slides along a wall at a distance d takes some length/d windows,
/// where the default method, whose bound of the travel knows directions, takes a few. So a motion
/// that it proves is free, but one that passes close for long may be `undecided` for want of work.
MotionResult certifyByBisection(MotionSource& motion, std::span<const MotionPair> pairs,
                                const MotionOptions& options, QueryContext& context);

}  // namespace corridor
