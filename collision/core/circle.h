#pragma once

#include <cmath>
#include <numbers>

#include "collision/core/floating_point.h"

namespace corridor {

/// If the difference of two angles differs from half a turn by at most this value, no rotation
/// between them counts as the shorter one (PROMISES.md, "What an edge is"). Radians.
inline constexpr double kHalfTurnBand = 1e-9;

/// The shorter rotation from one angle to another, and a bound on its rounding error; radians.
struct CircleTurn {
  double angle = 0;  ///< in [−π, π]
  double error = 0;

  /// True if the magnitude of the rotation may exceed π − `kHalfTurnBand`, given the bound on its
  /// rounding error. Also true if `angle` or `error` is NaN.
  bool ambiguous() const { return !(std::abs(angle) + error <= std::numbers::pi - kHalfTurnBand); }
};

/// Returns the shorter rotation from one angle to another; radians. The angles may be of any size.
///
/// Error, with S = |from| + |to|:
/// * If S < 64, or if the difference `to` − `from` is at most π in magnitude: the difference is
///   rounded once, by at most 2^-53·S. If the difference exceeds π, then at most S/2π + 1/2 ≤ S/π
///   whole turns are subtracted. Each turn is off by at most 2.5e-16, because 2π is rounded to a
///   double. The sum of these errors is below 2^-52·S. The returned `error` is 2^-51·S.
/// * For all other pairs of angles, the rotation is computed from sines and cosines in long double.
///   The C library reduces their arguments with as many digits of π as necessary. Sines and cosines
///   then cause an error of at most 2^-58, and rounding the result to double at most 2^-52.
inline CircleTurn circleTurn(double from, double to) {
  if (from == to) return {};
  const double turn = to - from, size = std::abs(from) + std::abs(to);
  if (std::abs(turn) <= std::numbers::pi) return {turn, 0x1p-51 * size};
  if (size < 64) return {std::remainder(turn, 2 * std::numbers::pi), 0x1p-51 * size};
  using Real = long double;
  const Real s0 = std::sin(Real(from)), c0 = std::cos(Real(from)), s1 = std::sin(Real(to)),
             c1 = std::cos(Real(to));
  return {static_cast<double>(std::atan2(s1 * c0 - c1 * s0, c1 * c0 + s1 * s0)), 0x1p-51};
}

/// Returns the angle minus a whole number of turns, in [−π, π]; radians. Before the final rounding
/// to double, the result is within 2^-53 of the real value. If |angle| < 1,000, at most 160 turns
/// are subtracted. Each of these turns is off by at most 2^-62, because 2π is rounded to long
/// double. For a larger |angle| the result is computed from sines and cosines, as in `circleTurn`.
inline double intoCircle(double angle) {
  if (std::abs(angle) <= std::numbers::pi) return angle;
  using Real = long double;
  if (std::abs(angle) < 1000)
    return static_cast<double>(std::remainder(Real(angle), 2 * std::numbers::pi_v<Real>));
  return static_cast<double>(std::atan2(std::sin(Real(angle)), std::cos(Real(angle))));
}

}  // namespace corridor
