#include "collision/motion/may_meet.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"

namespace corridor {

SweptBall sweptBall(const Body& b, const MotionWindow& window) {
  const Vec3 y = window.X_AB.m * b.sphereCenter();
  const Vec3 c = y + window.X_AB.t;
  const PointTravel travel = travelOf(window, c, b.sphereRadius());
  // c is off by less than 8u of its terms a coordinate: 16u as a length.
  const double terms = y.cwiseAbs().sum() + b.sphereRadius() + window.X_AB.t.cwiseAbs().sum();
  return {c, roundedUp(b.sphereRadius() + travel.cap + travel.pad + 16 * kUnit * terms)};
}

double clearanceBound(const Body& a, const SweptBall& ball) {
  const Vec3& c = ball.center;
  const Vec3 outside = (a.lower() - c).cwiseMax(c - a.upper()).cwiseMax(Vec3::Zero());
  // Squares that overflow, or underflow (to subnormals, that may be rounded up), tell nothing.
  // Differences are off by u of both terms, √3 of it as a length.
  const double gap = rootFromBelow(outside.squaredNorm());
  const double terms = c.cwiseAbs().sum() + a.lower().cwiseAbs().sum() + a.upper().cwiseAbs().sum();
  const double needed = roundedUp(ball.radius + 4 * kUnit * terms);
  return gap < HUGE_VAL && gap > needed ? std::max(0.0, roundedDown(roundedDown(gap) - needed)) : 0;
}

}  // namespace corridor
