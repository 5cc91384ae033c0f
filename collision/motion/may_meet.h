#pragma once

#include "collision/hierarchy/body.h"
#include "collision/motion/motion_window.h"

namespace corridor {

/// A ball that all of a body's points stay in all along a window of time, pads included, in the
/// frame of who looks on; metres. Bodies are kept apart by it before any tree is built.
struct SweptBall {
  Vec3 center = Vec3::Zero();
  double radius = 0;  ///< rounded up
};
SweptBall sweptBall(const Body& b, const MotionWindow& window);

/// How far the ball stays from body a's axis-aligned box at least, metres; 0: nothing is known.
double clearanceBound(const Body& a, const SweptBall& ball);
/// Can the ball come nearer than `margin` to it? `false` is a proof.
inline bool mayMeet(const Body& a, const SweptBall& ball, double margin) {
  return !(clearanceBound(a, ball) > margin);
}

}  // namespace corridor
