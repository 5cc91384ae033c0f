#pragma once

#include <cmath>

#include "collision/core/swept_ball.h"
#include "collision/hierarchy/body.h"
#include "collision/motion/motion_window.h"

namespace corridor {

/// The ball around b in the window, as a sees it.
SweptBall sweptBall(const Body& b, const MotionWindow& window);

/// How far the ball stays from body a's axis-aligned box at least, metres; 0: nothing is known.
/// What is more than `enough` may be told as less, but not as less than that.
double clearanceBound(const Body& a, const SweptBall& ball, double enough = HUGE_VAL);
/// How far two balls stay apart at least that are seen from the same frame, in the same window.
double clearanceBound(const SweptBall& a, const SweptBall& b, double enough = HUGE_VAL);
/// Can the ball come nearer than `margin` to it? `false` is a proof.
inline bool mayMeet(const Body& a, const SweptBall& ball, double margin) {
  return !(clearanceBound(a, ball, margin) > margin);
}

}  // namespace corridor
