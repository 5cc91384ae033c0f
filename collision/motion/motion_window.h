#pragma once

#include <cmath>
#include <span>

#include "collision/core/rounding.h"
#include "collision/core/transform.h"

namespace corridor {

/// How far a real motion may stray from the nominal one and still be covered by its proof: a
/// displacement of each coordinate of the position by at most `position` (metres) and a rotation by
/// at most `rotation` (radians).
struct Tube {
  double position = 0;
  double rotation = 0;
};

/// The share of one joint in a relative motion during a window of time, at the window's middle, in
/// the frame of the body that looks on.
struct ScrewTravel {
  enum class Kind {
    turn,   ///< about `axis` through `point`
    slide,  ///< along `axis`; `point` is not looked at
    ball,   ///< about any axis through `point`: tubes of free rotations only, `amount` is 0
  };
  Kind kind = Kind::turn;
  Vec3 axis = Vec3::Zero();   ///< unit but for rounding
  Vec3 point = Vec3::Zero();  ///< metres
  double amount = 0;  ///< half of what the joint does in the window, ≥ 0, rounded up; rad or m
  double tube = 0;    ///< what it may stray besides, ≥ 0; rad or m
};

/// What a body b does, as seen from a body a, in a window of time [t − h, t + h], told from its
/// middle. Both may move; a's frame A is at rest here, and the motion is that of the chain of
/// joints that leads from a to b, whose real map at the place |s| ≤ 1 of the window is
///   X_AB(s) = T_1(s·δ_1 + ε_1) … T_k(s·δ_k + ε_k),   |δ_j| = screws[j].amount, |ε_j| ≤ tube,
/// each T_j a turn or a slide about an axis that the joints before it carry along.
///
/// To first order a point x of b goes by s·(linear + angular × y), y = x − X_AB.t its lever from
/// b's origin; `travelOf` bounds the rest.
struct MotionWindow {
  Transform X_AB;                       ///< the map at the middle, rounded
  Vec3 linear = Vec3::Zero();           ///< half of the window's displacement of b's origin, metres
  Vec3 angular = Vec3::Zero();          ///< half of its rotation vector, radians
  double speed = 0;                     ///< |linear|, rounded up
  double angle = 0;                     ///< |angular|, rounded up
  std::span<const ScrewTravel> screws;  ///< from a's side to b's
  /// Rounding of all the above: at every s, every point of the real b is within fixedError +
  /// reachError·|y| metres of where these numbers, taken as exact, have it, and so are its
  /// distances from the axes. What else may stray may be in it, too.
  double fixedError = 0;
  double reachError = 0;
  double fixedTube = 0, reachTube = 0;  ///< the share of the two that is no rounding, but a tube
};

/// Bounds for all points of b within `radius` of a point: along any vector n,
///   |n·(x(s) − x(0) − s·(linear + angular × y))| ≤ bend·|n × angular| + curvature·|n|
/// and |x(s) − x(0)| ≤ cap; tube and rounding take `pad` more (what the tube takes at the middle;
/// its growth along the window is in `cap` and `curvature`). Rounded up.
struct PointTravel {
  double cap = 0, bend = 0, curvature = 0, pad = 0;
};

/// |v| rounded up, but for squares that vanish: below 2^-480 m or rad it may be less, by what the
/// windows' least errors stand for. Of nothing nothing: what `roundedUp` adds would be lost in
/// every sum, and subnormal in products, which are slow. NaN stays NaN.
inline double lengthFromAbove(const Vec3& v) {
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  return square == 0 && v.isZero(0) ? 0 : roundedUp(std::sqrt(square));
}

/// At least 2 sin(min(δ, π)/2), the chord of a turn by δ ≥ 0 at radius 1, and at most 0.5 % more:
/// Taylor's polynomial of degree 5 is above the sine, and grows up to δ = 3, where it is 2.002.
inline double chord(double amount) {
  if (!(amount < 3)) return 2;
  const double square = amount * amount;
  return amount * (1 - square * (1.0 / 24 - square / 1920));
}

/// Derivation in motion_window.cpp (numerics: «Chain bound, no enlargement», «Directional bounds»).
/// @param x_A the point at the middle, metres, in A.
PointTravel travelOf(const MotionWindow& window, const Vec3& x_A, double radius);

}  // namespace corridor
