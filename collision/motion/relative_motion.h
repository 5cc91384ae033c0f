#pragma once

#include <cmath>
#include <span>

#include "collision/core/rounding.h"
#include "collision/core/transform.h"

namespace corridor {

/// The neighbourhood of a nominal motion that a proof of the motion covers: each coordinate of the
/// position may differ by at most `position` (metres), and the orientation by a rotation of at most
/// `rotation` (radians).
struct Tube {
  double position = 0;
  double rotation = 0;
};

/// The motion of one joint of a kinematic chain in a time interval. The axis and the point are
/// given at the interval's middle, in frame A of body a.
struct ScrewMotion {
  enum class Kind {
    revolute,   ///< rotation about `axis` through `point`
    prismatic,  ///< translation along `axis`; `point` has no meaning
    /// A pivot rotation: a rotation about any axis through `point`. Used only for the tube of an
    /// unconstrained rotation; `amount` is 0.
    spherical,
  };
  Kind kind = Kind::revolute;
  Vec3 axis = Vec3::Zero();   ///< of unit length up to rounding
  Vec3 point = Vec3::Zero();  ///< metres
  double amount = 0;  ///< half of the joint's motion in the interval, ≥ 0, rounded up; rad or m
  double tube = 0;    ///< largest perturbation in addition to `amount`, ≥ 0; rad or m
  /// The largest deviation from a uniform motion by ±`amount` in the interval, ≥ 0, rounded up; rad
  /// or m. 0 if the joint moves uniformly. For a smooth motion it shrinks with the square of the
  /// interval's length. A joint that reverses its direction at the middle has `amount` 0 and a
  /// positive deviation.
  double deviation = 0;
};

/// The motion of a body b relative to a body a in a time interval [t − h, t + h], described from
/// the interval's middle t.
///
/// Both bodies may move in the world. The motion is seen from frame A of a, so A is at rest here.
/// The motion is that of the kinematic chain from a to b. At time t + s·h, |s| ≤ 1, its exact map
/// is
///   X_AB(s) = T_1(s·δ_1 + η_1(s) + ε_1) … T_k(s·δ_k + η_k(s) + ε_k),
///   |δ_j| ≤ screws[j].amount, η_j(0) = 0, |η_j| ≤ screws[j].deviation, |ε_j| ≤ screws[j].tube.
/// Each T_j is a rotation about an axis, or a translation along an axis. (For a pivot rotation, T_j
/// is a rotation by at most `tube` about any axis through its point.) The axis of joint j is moved
/// by the joints before j.
///
/// To first order a point x of b moves by s·(linear + angular × y). Its lever y = x − X_AB.t is the
/// vector from b's origin to x. `motionBound` bounds the remainder.
struct RelativeMotion {
  Transform X_AB;               ///< the map at the middle, rounded
  Vec3 linear = Vec3::Zero();   ///< half of the displacement of b's origin in the interval, metres
  Vec3 angular = Vec3::Zero();  ///< half of the interval's rotation vector, radians
  double speed = 0;             ///< |linear|, rounded up; metres
  double angle = 0;             ///< |angular|, rounded up; radians
  std::span<const ScrewMotion> screws;  ///< the joints in order from a to b
  /// Bounds of the errors of all numbers above. At every s, each point of the real b is within
  /// fixedError + reachError·|y| metres of the place that these numbers, taken as exact, give it.
  /// The same bound holds for the error of the point's distances from the axes. The errors may also
  /// include perturbations: a tube, or the clearance slack of a query.
  double fixedError = 0;
  double reachError = 0;
  /// The parts of `fixedError` and `reachError` that come from a tube, not from rounding.
  double fixedTube = 0, reachTube = 0;
};

/// Makes a motion prove nothing if one of its numbers is NaN: `fixedError` becomes NaN. (Minima and
/// comparisons may drop a NaN elsewhere, but no bound drops one of `fixedError`.)
void spreadNaN(RelativeMotion& relative);

/// A motion bound for all points x of b within a radius of a given point. For every vector n and
/// every s
///   |n·(x(s) − x(0) − s·(linear + angular × y))| ≤ secondOrderAcross·|n × angular| +
///   secondOrder·|n| + pad·|n|
/// and |x(s) − x(0)| ≤ isotropic + pad.
/// * `pad` bounds the rounding errors, and the displacement by the tube at the middle.
/// * `isotropic` and `secondOrder` include the deviations of the joints from uniform motion, and
///   the tube's growth: how much more the tube can displace the points at other times of the
///   interval.
///
/// All four numbers are rounded up. They are in metres, except `secondOrderAcross` (metres per
/// radian of `angular`).
struct MotionBound {
  double isotropic = 0, secondOrderAcross = 0, secondOrder = 0, pad = 0;
};

/// Returns |v|, rounded up.
/// * Below 2^-480 (metres or radians) squares underflow, and the result may be less than |v|. Every
///   relative motion includes an error that covers this (`kLeastError` in rigid_motion.cpp).
/// * The result for a zero vector is exactly 0, not the tiny constant that `roundedUp` would add.
///   The constant would not change any sum, and products with it would be subnormal, hence slow.
/// * NaN stays NaN.
inline double lengthFromAbove(const Vec3& v) {
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  return square == 0 && v.isZero(0) ? 0 : roundedUp(std::sqrt(square));
}

/// Returns an upper bound of 2 sin(min(δ, π)/2), the chord of a rotation by δ ≥ 0 at radius 1. The
/// bound exceeds the chord by at most 0.5 %. It is Taylor's polynomial of degree 5, which is above
/// 2 sin(δ/2) and increases up to δ = 3, where its value is 2.002. From there on the bound is 2.
inline double chord(double amount) {
  if (!(amount < 3)) return 2;
  const double square = amount * amount;
  return amount * (1 - square * (1.0 / 24 - square / 1920));
}

/// Returns the motion bound of all points of b within `radius` metres of the point `x_A`. The
/// derivation is in relative_motion.cpp (see also collision/NUMERICS.md, "The motion bound of a
/// kinematic chain needs no enlarged radii" and "Directional bounds").
/// @param x_A the point at the interval's middle, in A, metres.
MotionBound motionBound(const RelativeMotion& relative, const Vec3& x_A, double radius);

}  // namespace corridor
