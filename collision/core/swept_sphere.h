#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// A bounding sphere of a body at the middle of a time interval, with a bound on the motion of the
/// sphere's centre in the interval. Sphere and bound are in the frame from which the motion is
/// seen: the world, or the frame of body a. Rotation of the body about the centre does not move the
/// sphere. Queries use the sphere to prove that distant bodies are separated, before any tree is
/// built (motion/may_meet.h).
struct SweptSphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;     ///< includes the motion's tube and rounding; rounded up; metres
  double isotropic = 0;  ///< isotropic motion bound of the centre, rounded up; metres
  /// Directional motion bound: along a unit vector n the centre moves by at most |n·first| + |n ×
  /// angular|·secondOrderAcross + secondOrder.
  Vec3 first = Vec3::Zero(), angular = Vec3::Zero();  ///< metres, radians
  double secondOrderAcross = 0, secondOrder = 0;      ///< metres
};

}  // namespace corridor
