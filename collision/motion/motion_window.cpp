#include "collision/motion/motion_window.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"

/// Derivation. With T_j(φ) the turn by φ about the j-th axis, or the slide along it, where that
/// axis is at the window's middle, a point of b that is at x at the middle goes along
///   x(s, ε) = T_1(sδ_1 + ε_1) … T_k(sδ_k + ε_k) x        (product of exponentials),
/// δ_j ≥ 0 (flip axes), |s| ≤ 1. Let r_j be the distance of x from axis j (of a ball: from its
/// point); z_j = T_j(sδ_j) … T_k(sδ_k) x the point that only the joints from j on have moved.
///
/// Cap (no enlargement). x(s) − x = Σ_j T_1(sδ_1) … T_(j−1)(sδ_(j−1)) [T_j(sδ_j) x − x]: what is
/// before j is an isometry, what is after it is at the middle. A turn's bracket is a chord
/// 2 r_j sin(min(|sδ_j|, π)/2), a slide's |sδ_j|. So |z_j − x| ≤ D_j = Σ_(i ≥ j) of these at s = 1,
/// and |x(s) − x| ≤ D_1. Of `displaced`, D_(j+1) comes before joint j is added.
///
/// Remainder. ∂x/∂φ_j is a_j × (z_(j+1) − p_j), turned by what is before j: its length is the
/// distance of z_(j+1) from axis j, at most r̄_j = r_j + D_(j+1); a slide's is 1. A second
/// derivative by i ≤ j turns that about axis i: at most the same where i is a turn, 0 where it is a
/// slide. So
///   |x''(s)| ≤ Σ_(turns j) δ_j² r̄_j + 2 Σ_(turns i) δ_i Σ_(j > i) δ_j r̄_j   (slides: r̄_j = 1)
/// and by Taylor's formula along any n, |n·(x(s) − x − s x'(0))| ≤ ½ max|x''|·|n|. `rate` is the
/// inner sum.
///
/// One turn alone, by δ about k, with no slide after it (slides before it only add what is linear
/// in s): with y the lever from the axis, |y − (k·y)k| = r_j, φ = sδ, Rodrigues' formula leaves
///   (1 − cos φ) k × (k × y) + (sin φ − φ) k × y,
/// at a right angle to k and of length r|e^(iφ) − 1 − iφ| ≤ r φ²/2: along n at most
/// ½ r δ²|n × k| = ½ r δ |n × angular|. That is `bend`. The stored `angular` is off: its direction
/// by rounding, which takes `tilt`·r δ²; its length δ by the window's reachError e (the rounding of
/// the rate), which takes ½ r δ e here, and r δ e where the second order is computed itself
/// (moving_triangles.cpp): `amount` is no less than the real δ, and no more than e above |angular|,
/// so that ½ r (δ² − |angular|²) ≤ r·amount·e. `curvature` has r·amount·e.
///
/// Tube. x(s, ε) − x(s, 0) = Σ_j T_1(sδ_1 + ε_1) … [T_j(sδ_j + ε_j) − T_j(sδ_j)] z_(j+1): what is
/// after j is nominal. A bracket is at most |ε_j| times the distance of z_(j+1) from axis j, r̄_j
/// again (slides: 1). At the middle itself D = 0, so r_j τ_j goes to `pad`; D_(j+1) τ_j is the
/// window's and goes to `cap` and `curvature`: a shorter window has less of it.
///
/// Rounding. The window vouches for its own numbers (`fixedError`, `reachError`): those of a point
/// at x are off by at most E = fixedError + reachError·|y|, y its lever, and so are its distances
/// from the axes; all r_j grow by that. Here: y, x − p_j and the products are off by a few u of
/// their terms, `loose`; sums of positive terms by u each, the factor in the end.
namespace corridor {
namespace {

double taxicab(const Vec3& v) {
  return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
}

double length(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z);
}

/// |a × b|, without a vector in between.
double lengthOfCross(const Vec3& a, const Vec3& b) {
  return length(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
}

/// Metres: squares under 2^-1022 vanish, and lengths under 2^-511 with them.
constexpr double kLeastLength = 0x1p-500;

}  // namespace

PointTravel travelOf(const MotionWindow& window, const Vec3& x_A, double radius) {
  const Vec3 y = x_A - window.X_AB.t;
  const double loose = 16 * kUnit * (taxicab(y) + taxicab(window.X_AB.t) + radius) + kLeastLength;
  const double lever = length(y[0], y[1], y[2]);
  const double error = window.fixedError + window.reachError * (lever + radius + loose);
  const double grown = radius + error + loose;

  const double scale = 1 + kUnit * static_cast<double>(64 + 8 * window.screws.size());
  double displaced = 0, rate = 0, second = 0, pad = error, stray = 0;
  double sole = 0;  // r δ of a turn that is alone so far
  int turns = 0;
  for (std::size_t j = window.screws.size(); j-- > 0;) {
    const ScrewTravel& screw = window.screws[j];
    if (screw.kind == ScrewTravel::Kind::slide) {
      displaced += screw.amount;
      rate += screw.amount;
      pad += screw.tube;
      continue;
    }
    const Vec3 d = x_A - screw.point;
    const double r = (screw.kind == ScrewTravel::Kind::turn ? lengthOfCross(screw.axis, d)
                                                            : length(d[0], d[1], d[2])) +
                     grown + 16 * kUnit * taxicab(d);
    pad += r * screw.tube;
    stray += displaced * screw.tube;
    if (screw.amount == 0) continue;
    const double onward = (r + displaced) * screw.amount;
    sole = turns == 0 && rate == 0 ? onward : 0;
    ++turns;
    second += screw.amount * (onward + 2 * rate);
    rate += onward;
    displaced += r * chord(screw.amount);
  }

  PointTravel travel;
  travel.pad = scale * pad;
  if (displaced == 0) return travel;  // only a tube is left, all of it at the middle
  const Vec3& l = window.linear;
  const Vec3& w = window.angular;
  const double firstOrder =
      length(l[0] + (w[1] * y[2] - w[2] * y[1]), l[1] + (w[2] * y[0] - w[0] * y[2]),
             l[2] + (w[0] * y[1] - w[1] * y[0])) +
      window.angle * grown + 16 * kUnit * (window.speed + window.angle * lever) + 0.5 * second;
  travel.cap = scale * (std::min(displaced, firstOrder) + stray);
  const bool bends = sole > 0 && turns == 1;
  const double tilt = bends ? window.reachError + 8 * kUnit : 0.5;
  travel.bend = bends ? scale * 0.5 * sole : 0;
  travel.curvature = scale * (tilt * second + (bends ? window.reachError * sole : 0) + stray);
  return travel;
}

}  // namespace corridor
