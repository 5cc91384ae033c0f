#include "collision/motion/may_meet.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"

namespace corridor {

SweptBall sweptBall(const Body& b, const MotionWindow& window) {
  const Vec3 y = window.X_AB.m * b.sphereCenter();
  const Vec3 c = y + window.X_AB.t;
  const PointTravel travel = travelOf(window, c, 0);
  // c is off by less than 8u of its terms a coordinate: 16u as a length. The body is rigid but for
  // what `reachError` says of the map.
  const double radius = b.sphereRadius() * (1 + window.reachError);
  const double terms = y.cwiseAbs().sum() + b.sphereRadius() + window.X_AB.t.cwiseAbs().sum();
  SweptBall ball;
  ball.center = c;
  ball.radius = roundedUp(radius + travel.pad + 16 * kUnit * terms);
  ball.cap = travel.cap;
  // y is off as c is, by 16u of its terms; the product and sum here, and those that ask for a
  // direction, 16u more; the direction itself 8u. Lengths under 2^-511 vanish when squared.
  ball.first = window.linear + window.angular.cross(y);
  ball.angular = window.angular;
  ball.bend = travel.bend;
  ball.curvature = roundedUp(travel.curvature + 0x1p-500 * (1 + travel.bend) +
                             48 * kUnit * (window.speed + window.angle * (terms + travel.bend)));
  return ball;
}

double clearanceBound(const Body& a, const SweptBall& ball) {
  const Vec3& c = ball.center;
  const Vec3 zero = Vec3::Zero();
  const Vec3 outside = (c - a.upper()).cwiseMax(zero) - (a.lower() - c).cwiseMax(zero);
  // Squares that overflow, or underflow (to subnormals, that may be rounded up), tell nothing.
  // Differences are off by u of both terms, √3 of it as a length.
  const double gap = rootFromBelow(outside.squaredNorm());
  const double terms = c.cwiseAbs().sum() + a.lower().cwiseAbs().sum() + a.upper().cwiseAbs().sum();
  // Along n the centre is `gap` beyond the box's farthest point. Of none (gap 0): NaN, and the cap.
  const Vec3 n = outside / gap;
  const double along =
      std::abs(n.dot(ball.first)) + n.cross(ball.angular).norm() * ball.bend + ball.curvature;
  const double travel = along < ball.cap ? along : ball.cap;
  const double needed = roundedUp(ball.radius + travel + 4 * kUnit * terms);
  return gap < HUGE_VAL && gap > needed ? std::max(0.0, roundedDown(roundedDown(gap) - needed)) : 0;
}

}  // namespace corridor
