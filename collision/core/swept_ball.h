#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// A ball around a body at the middle of a window of time, and how far its centre goes in the
/// window, in the frame of who looks on: the body may turn in it as it likes. Bodies are kept apart
/// by it before any tree is built (motion/may_meet.h).
struct SweptBall {
  Vec3 center = Vec3::Zero();
  double radius = 0;  ///< pads included, rounded up; metres
  double cap = 0;     ///< the centre goes no farther, rounded up; metres
  /// Along a unit n it goes no farther than |n·first| + |n × angular|·bend + curvature.
  Vec3 first = Vec3::Zero(), angular = Vec3::Zero();  ///< metres, radians
  double bend = 0, curvature = 0;                     ///< metres
};

}  // namespace corridor
