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

namespace {

/// What is left of `gap` metres, computed along (c_b − c_a)/gap, after `radius`, rounding and the
/// way that `cap` and, where that isn't enough, `along(n)` bound.
template <class Along>
double remaining(const Vec3& apart, double gap, double radius, double cap, double rounding,
                 double enough, const Along& along) {
  if (!(gap < HUGE_VAL)) return 0;  // squares that overflow tell nothing
  const auto beyond = [&](double travel) {
    const double needed = roundedUp(radius + travel + rounding);
    return gap > needed ? std::max(0.0, roundedDown(roundedDown(gap) - needed)) : 0;
  };
  const double least = beyond(cap);
  if (least > enough || cap == 0 || !(gap > radius)) return least;
  const double travel = along(Vec3(apart / gap));
  return travel < cap ? beyond(travel) : least;
}

/// Beyond n·first.
double bent(const SweptBall& ball, const Vec3& n) {
  return n.cross(ball.angular).norm() * ball.bend + ball.curvature;
}

}  // namespace

double clearanceBound(const Body& a, const SweptBall& ball, double enough) {
  const Vec3& c = ball.center;
  const Vec3 zero = Vec3::Zero();
  const Vec3 outside = (c - a.upper()).cwiseMax(zero) - (a.lower() - c).cwiseMax(zero);
  // Underflow (to subnormals, that may be rounded up) tells nothing. Differences are off by u of
  // both terms, √3 of it as a length. Along n the centre is `gap` beyond the box's farthest point.
  return remaining(outside, rootFromBelow(outside.squaredNorm()), ball.radius, ball.cap,
                   4 * kUnit * (c.cwiseAbs().sum() + a.boundTerms()), enough,
                   [&](const Vec3& n) { return std::abs(n.dot(ball.first)) + bent(ball, n); });
}

/// Along the line between the two centres at the middle: one goes against the other by the
/// difference of what they go to first order, and what each may bend. (The difference rounds by u
/// of both; of the 48u of its speeds in each ball's curvature 40u are used up in `sweptBall`.)
double clearanceBound(const SweptBall& a, const SweptBall& b, double enough) {
  const Vec3 apart = b.center - a.center;
  return remaining(
      apart, rootFromBelow(apart.squaredNorm()), a.radius + b.radius, a.cap + b.cap,
      4 * kUnit * (a.center.cwiseAbs().sum() + b.center.cwiseAbs().sum()), enough,
      [&](const Vec3& n) { return std::abs(n.dot(b.first - a.first)) + bent(a, n) + bent(b, n); });
}

}  // namespace corridor
