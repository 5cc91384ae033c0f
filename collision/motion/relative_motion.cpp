#include "collision/motion/relative_motion.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"

/// Derivation. Let T_j(φ) be the rotation by φ about the j-th axis, or the translation by φ along
/// it. The axis is taken at its place at the interval's middle. A point of b that is at x at the
/// middle follows
///   x(s, ε) = T_1(sδ_1 + ε_1) … T_k(sδ_k + ε_k) x        (product of exponentials),
/// with δ_j ≥ 0 (after flipping axes) and |s| ≤ 1. Let r_j be the distance of x from axis j (for a
/// pivot rotation: from its point). Let z_j = T_j(sδ_j) … T_k(sδ_k) x: the point after the motion
/// of joints j to k only.
///
/// Isotropic bound, `isotropic` (without enlarged radii).
///   x(s) − x = Σ_j T_1(sδ_1) … T_(j−1)(sδ_(j−1)) [T_j(sδ_j) x − x].
/// The factors before the bracket are an isometry, and x in the bracket is at the middle. The
/// length of the bracket is a chord, 2 r_j sin(min(|sδ_j|, π)/2), for a rotation, and |sδ_j| for a
/// translation. Let D_j be the sum of these lengths over the joints i ≥ j, at s = 1. Then |z_j − x|
/// ≤ D_j and |x(s) − x| ≤ D_1. The variable `displaced` is D_(j+1) before joint j is added to it.
///
/// Remainder. ∂x/∂φ_j is a_j × (z_(j+1) − p_j), rotated by the joints before j. Its length is the
/// distance of z_(j+1) from axis j, at most r̄_j = r_j + D_(j+1); for a translation it is 1. The
/// second derivative by the joints j and i ≤ j differentiates this vector by the motion of joint i.
/// If joint i is a rotation, the result is at most as long as the vector. If joint i is a
/// translation, the result is 0. Therefore
///   |x''(s)| ≤ Σ_(rotations j) δ_j² r̄_j + 2 Σ_(rotations i) δ_i Σ_(j > i) δ_j r̄_j
/// with r̄_j = 1 for translations. By Taylor's formula, for any n,
///   |n·(x(s) − x − s x'(0))| ≤ ½ max|x''|·|n|.
/// The variable `rate` is the inner sum.
///
/// A single rotation by δ about k, with no translation after it. (Translations before it only add
/// terms that are linear in s.) Let y be the lever from the axis, |y − (k·y)k| = r_j, and φ = sδ.
/// By Rodrigues' formula the remainder is
///   (1 − cos φ) k × (k × y) + (sin φ − φ) k × y.
/// The remainder is orthogonal to k, and its length is r|e^(iφ) − 1 − iφ| ≤ r φ²/2. Along n it is
/// at most
///   ½ r δ²|n × k| = ½ r δ |n × angular|.
/// The factor ½ r δ is `secondOrderAcross`. Two errors of the stored `angular` are added to
/// `secondOrder`:
/// * Rounding tilts its direction. This adds `tilt`·r δ².
/// * Its length differs from δ by at most the interval's reachError e (the rounding of the rate).
///   This adds ½ r δ e here, and r δ e where the second order is computed in full
///   (moving_triangles.cpp). `amount` is at least the real δ, and at most e above |angular|.
///   Therefore ½ r (δ² − |angular|²) ≤ r·amount·e, which is the term added.
///
/// Deviations. Joint j moves by σ_j(s) = sδ_j + η_j(s) instead of sδ_j, with |η_j| ≤ ρ_j (its
/// `deviation`). In `isotropic`, |σ_j| ≤ δ_j + ρ_j takes the place of δ_j, also in D_j. The curve
/// above, with all η = 0, is the uniform one. The difference from it is
///   x(s, η) − x(s, 0) = Σ_j T_1(σ_1) … T_(j−1)(σ_(j−1)) [T_j(σ_j) − T_j(sδ_j)] z_(j+1),
/// where the joints after j move uniformly. A bracket is at most |η_j| times the distance of
/// z_(j+1) from axis j, at most ρ_j r̄_j (ρ_j for translations). The variable `deviated` is the sum
/// of these terms. It adds to `secondOrder`, and not to `pad`, because it vanishes as the interval
/// gets shorter.
///
/// Tube. With σ as above, a tube displaces the point further by
///   x(s, η + ε) − x(s, η) = Σ_j T_1(σ_1 + ε_1) … [T_j(σ_j + ε_j) − T_j(σ_j)] z_(j+1),
/// where now z_(j+1) is the point after the motions σ of the joints after j. A bracket is at most
/// |ε_j| times the distance of z_(j+1) from axis j, which is again at most r̄_j (1 for
/// translations). At the middle D = 0, so the tube adds r_j τ_j there, where τ_j is the joint's
/// `tube`. This term goes to `pad`. The rest, D_(j+1) τ_j, decreases with the length of the
/// interval. It goes to `isotropic` and `secondOrder`.
///
/// Rounding. The relative motion states the error of its own numbers (`fixedError`, `reachError`).
/// For a point with lever y this error is at most E = fixedError + reachError·|y|. The distances
/// from the axes are also off by at most E, so every r_j grows by E. In `motionBound`, y, x − p_j
/// and the products are off by a few u of their terms, which `loose` covers. Each sum of positive
/// terms is off by a few u, which the factor `scale` covers at the end.
namespace corridor {
namespace {

double taxicab(const Vec3& v) {
  return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
}

double length(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z);
}

/// Returns |a × b| without building the cross product as a vector.
double lengthOfCross(const Vec3& a, const Vec3& b) {
  return length(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

/// A term of the rounding bound, metres. It covers lengths below 2^-511, whose squares underflow.
constexpr double kLeastLength = 0x1p-500;

}  // namespace

void spreadNaN(RelativeMotion& relative) {
  // A NaN in `X_AB`, or in the axis, point or tube of a rotation, is already in every pad.
  double sum = relative.linear.sum() + relative.angular.sum() + relative.speed + relative.angle +
               relative.reachError;
  for (const ScrewMotion& screw : relative.screws) sum += screw.amount + screw.deviation;
  if (std::isnan(sum)) relative.fixedError = sum;
}

MotionBound motionBound(const RelativeMotion& relative, const Vec3& x_A, double radius) {
  const Vec3 y = x_A - relative.X_AB.t;
  const double loose = 16 * kUnit * (taxicab(y) + taxicab(relative.X_AB.t) + radius) + kLeastLength;
  const double lever = length(y[0], y[1], y[2]);
  const double error = relative.fixedError + relative.reachError * (lever + radius + loose);
  const double grown = radius + error + loose;

  const double scale = 1 + kUnit * static_cast<double>(64 + 8 * relative.screws.size());
  double displaced = 0, rate = 0, second = 0, pad = error, tubeGrowth = 0, deviated = 0;
  // r δ of the only rotation so far, if no translation comes after it in the chain; otherwise 0.
  double singleTravel = 0;
  int turns = 0;
  for (std::size_t j = relative.screws.size(); j-- > 0;) {
    const ScrewMotion& screw = relative.screws[j];
    if (screw.kind == ScrewMotion::Kind::prismatic) {
      displaced += screw.amount + screw.deviation;
      rate += screw.amount;
      deviated += screw.deviation;
      pad += screw.tube;
      continue;
    }
    const Vec3 d = x_A - screw.point;
    const double r = (screw.kind == ScrewMotion::Kind::revolute ? lengthOfCross(screw.axis, d)
                                                                : length(d[0], d[1], d[2])) +
                     grown + 16 * kUnit * taxicab(d);
    pad += r * screw.tube;
    tubeGrowth += displaced * screw.tube;
    const double most = screw.amount + screw.deviation;
    if (most == 0) continue;
    deviated += (r + displaced) * screw.deviation;
    if (screw.amount > 0) {
      const double onward = (r + displaced) * screw.amount;
      singleTravel = turns == 0 && rate == 0 ? onward : 0;
      ++turns;
      second += screw.amount * (onward + 2 * rate);
      rate += onward;
    }
    displaced += r * chord(most);
  }

  MotionBound bound;
  bound.pad = scale * pad;
  if (displaced == 0) return bound;  // only a tube is left: all of it is in `pad`
  const Vec3& l = relative.linear;
  const Vec3& w = relative.angular;
  const double firstOrder =
      length(l[0] + (w[1] * y[2] - w[2] * y[1]), l[1] + (w[2] * y[0] - w[0] * y[2]),
             l[2] + (w[0] * y[1] - w[1] * y[0])) +
      relative.angle * grown + 16 * kUnit * (relative.speed + relative.angle * lever) +
      0.5 * second + deviated;
  bound.isotropic = scale * (std::min(displaced, firstOrder) + tubeGrowth);
  const bool isSingleRotation = singleTravel > 0 && turns == 1;
  const double tilt = isSingleRotation ? relative.reachError + 8 * kUnit : 0.5;
  bound.secondOrderAcross = isSingleRotation ? scale * 0.5 * singleTravel : 0;
  bound.secondOrder =
      scale * (tilt * second + (isSingleRotation ? relative.reachError * singleTravel : 0) +
               deviated + tubeGrowth);
  return bound;
}

}  // namespace corridor
