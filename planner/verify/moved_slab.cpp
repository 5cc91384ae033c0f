#include "planner/verify/moved_slab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace corridor::verify {
namespace {

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
/// The largest turn of a slab's direction in half of an interval, rad.
constexpr Real kMostTurn = 0.125L;
/// The largest number of pairs of leaf primitives that are proved one by one in a time interval,
/// each by its own slab. With more pairs it costs less to halve the interval.
constexpr std::size_t kMostSlabs = 400;
/// The limit that replaces kMostSlabs in intervals in which the tube displaces points farther than
/// the motion does. Halving such an interval gains little.
constexpr std::size_t kMostSlabsInTube = 64 * kMostSlabs;

}  // namespace

BodyMotion motionSeenFrom(const Placement& at, const FrameState& state, Perturbation perturbation) {
  const RealMat back = at.rotation.transpose();
  const auto seen = [&](RealVec& linear, RealVec& angular) {
    linear = back * (linear + angular.cross(at.position));
    angular = back * angular;
  };
  BodyMotion motion{state.linear, state.angular, std::move(perturbation)};
  seen(motion.linear, motion.angular);
  for (Perturbation::Twist& twist : motion.perturbation.twists) seen(twist.linear, twist.angular);
  for (Perturbation::PivotRotation& pivot : motion.perturbation.pivots)
    pivot.at = back * (pivot.at - at.position);
  return motion;
}

MovedSlab::MovedSlab(const BodyMotion& a, const BodyMotion& b, Real half, const RealVec& direction,
                     const RealVec& turn, Real displacement) {
  const Real length = direction.norm();
  if (!(length > 0)) return;
  const RealVec normal = direction / length, rate = turn.cross(normal);
  const Real turned = half * rate.norm();
  if (!(turned <= kMostTurn)) return;
  normal_ = normal;
  lost_ = turned > 0 ? turned * displacement : 0;  // 0·∞ would be NaN
  shorter_ = turned * turned / 2;
  a_ = sideOf(a, half, normal_, rate);
  b_ = sideOf(b, half, -normal_, -rate);
}

/// @param rate the change of `along` per unit of t.
MovedSlab::Side MovedSlab::sideOf(const BodyMotion& motion, Real half, const RealVec& along,
                                  const RealVec& rate) const {
  // n·(linear + angular × x) = n·linear + (n × angular)·x.
  const auto seen = [&](const RealVec& linear, const RealVec& angular) {
    return Affine{along.cross(angular), along.dot(linear)};
  };
  Affine velocity = seen(motion.linear, motion.angular);
  velocity.slope += rate;
  Side side;
  side.back = {along - half * velocity.slope, -half * velocity.constant};
  side.forth = {along + half * velocity.slope, half * velocity.constant};
  for (const Perturbation::Twist& twist : motion.perturbation.twists)
    side.twists.push_back(seen(twist.linear, twist.angular));
  side.pivots = motion.perturbation.pivots;
  return side;
}

Real MovedSlab::perturbationOf(const Side& side, const RealVec& x) const {
  Real sum = 0;
  for (const Affine& twist : side.twists) sum += std::abs(twist.at(x));
  for (const Perturbation::PivotRotation& pivot : side.pivots)
    sum += pivot.angle * normal_.cross(x - pivot.at).norm();
  return sum;
}

MovedSlab::Support MovedSlab::supportOf(const Side& side, const ConvexSet& set) const {
  Support most{-kInfinity, -kInfinity};
  for (const RealVec& x : set.points) {
    const Real perturbation = perturbationOf(side, x);
    most.back = std::max(most.back, side.back.at(x) + perturbation);
    most.forth = std::max(most.forth, side.forth.at(x) + perturbation);
  }
  if (set.flatEnds) {
    const auto across = [&](const RealVec& g) { return (g - set.axis * set.axis.dot(g)).norm(); };
    Real perturbation = 0;
    for (const Affine& twist : side.twists) perturbation += across(twist.slope);
    for (const Perturbation::PivotRotation& pivot : side.pivots) perturbation += pivot.angle;
    most.back += set.radius * (across(side.back.slope) + perturbation);
    most.forth += set.radius * (across(side.forth.slope) + perturbation);
  }
  most.back += set.sweptRadius();
  most.forth += set.sweptRadius();
  return most;
}

MovedSlab::Support MovedSlab::supportOf(const Side& side, const CentredBox& box) const {
  const auto within = [&](const RealVec& g) { return g.cwiseAbs().dot(box.half); };
  Real perturbation = perturbationOf(side, box.centre);
  for (const Affine& twist : side.twists) perturbation += within(twist.slope);
  if (!side.pivots.empty()) {
    const Real radius = box.half.norm();
    for (const Perturbation::PivotRotation& pivot : side.pivots)
      perturbation += pivot.angle * radius;
  }
  return {side.back.at(box.centre) + within(side.back.slope) + perturbation,
          side.forth.at(box.centre) + within(side.forth.slope) + perturbation};
}

/// @param radii the sum of `sweptRadius()` of both sets.
Real MovedSlab::widthOf(const Support& a, const Support& b, Real radii) const {
  const Real along = std::min(-a.back - b.back, -a.forth - b.forth) - lost_;
  return along - shorter_ * std::max<Real>(0, along + radii);
}

Real MovedSlab::width(const ConvexSet& a, const ConvexSet& b) const {
  if (normal_.isZero(0)) return -kInfinity;
  return widthOf(supportOf(a_, a), supportOf(b_, b), a.sweptRadius() + b.sweptRadius());
}

Real MovedSlab::width(const CentredBox& a, const CentredBox& b) const {
  if (normal_.isZero(0)) return -kInfinity;
  return widthOf(supportOf(a_, a), supportOf(b_, b), 0);
}

Real boundBySlabs(BodyDistance& placed, const BodyGap& measured, const PairMotion& motion,
                  const Sought& sought, std::vector<LeafPair>& scratch) {
  const Real lost = motion.secondOrder + motion.rounding;
  // In any direction, motion, tube and rounding reduce a distance by at most this much.
  const Real most = motion.motionBound + motion.tube + motion.rounding;
  const auto slabAlong = [&](const RealVec& direction, const RealVec& turn) {
    return MovedSlab(motion.a, motion.b, motion.half, direction, turn,
                     motion.motionBound + motion.tube);
  };
  const RealVec fixed = RealVec::Zero();
  const MovedSlab general = slabAlong(measured.onB - measured.onA, fixed);
  // Every direction gives a true bound, so several are tried: the direction between the closest
  // points of the bodies; the direction between the closest points of the two leaf primitives; and
  // the triangles' normals, for triangles that face each other at an angle. Directions may turn
  // with either body.
  const auto boundOf = [&](LeafPair pair) {
    const ConvexSet a = placed.setA(pair.a), b = placed.setB(pair.b);
    Real best = general.width(a, b) - lost;
    if (best >= sought.wanted) return best;
    const auto attempt = [&](const RealVec& n) {
      for (const RealVec* turn : {&fixed, &motion.a.angular, &motion.b.angular})
        if (best < sought.wanted && (turn == &fixed || !turn->isZero(0)))
          best = std::max(best, slabAlong(n, *turn).width(a, b) - lost);
    };
    const DistanceBounds gap = placed.gap(pair);
    best = std::max(best, gap.lower - most);
    attempt(gap.onB - gap.onA);
    for (const ConvexSet* set : {&a, &b}) {
      if (set->points.size() != 3) continue;
      const RealVec normal =
          (set->points[1] - set->points[0]).cross(set->points[2] - set->points[0]);
      attempt(normal);
      attempt(-normal);
    }
    return best;
  };
  if (measured.lower - lost <= sought.needed || boundOf(measured.pair) <= sought.needed)
    return -kInfinity;
  // Pairs of leaf primitives that are farther apart than `bound + most` need no slab. A pair of
  // boxes that the general slab separates by `bound` is settled: its leaf primitives need no slab.
  const std::size_t count = motion.tube > motion.motionBound ? kMostSlabsInTube : kMostSlabs;
  for (Real bound : {sought.wanted, sought.little}) {
    const auto settled = [&](const CentredBox& a, const CentredBox& b) {
      return general.width(a, b) - lost >= bound;
    };
    if (!std::isfinite(bound) || !placed.collectNear(bound + most, count, settled, scratch))
      continue;
    for (const LeafPair& pair : scratch) {
      bound = std::min(bound, boundOf(pair));
      if (bound <= sought.needed) return -kInfinity;
    }
    return bound;
  }
  return -kInfinity;
}

}  // namespace corridor::verify
