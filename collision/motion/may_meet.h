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

/// Can the ball come nearer than `margin` to body a's axis-aligned box? `false` is a proof.
bool mayMeet(const Body& a, const SweptBall& ball, double margin);

}  // namespace corridor
