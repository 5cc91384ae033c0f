#pragma once

#include "collision/hierarchy/body.h"
#include "collision/motion/motion_window.h"

namespace corridor {

/// A ball around a body at the middle of a window of time, and how far its centre goes in the
/// window, in the frame of who looks on: the body may turn in it as it likes. Bodies are kept apart
/// by it before any tree is built.
struct SweptBall {
  Vec3 center = Vec3::Zero();
  double radius = 0;  ///< pads included, rounded up; metres
  double cap = 0;     ///< the centre goes no farther, rounded up; metres
  /// Along a unit n it goes no farther than |n·first| + |n × angular|·bend + curvature.
  Vec3 first = Vec3::Zero(), angular = Vec3::Zero();  ///< metres, radians
  double bend = 0, curvature = 0;                     ///< metres
};
SweptBall sweptBall(const Body& b, const MotionWindow& window);

/// How far the ball stays from body a's axis-aligned box at least, metres; 0: nothing is known.
double clearanceBound(const Body& a, const SweptBall& ball);
/// Can the ball come nearer than `margin` to it? `false` is a proof.
inline bool mayMeet(const Body& a, const SweptBall& ball, double margin) {
  return !(clearanceBound(a, ball) > margin);
}

}  // namespace corridor
