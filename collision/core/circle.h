#pragma once

#include <cmath>
#include <numbers>

#include "collision/core/floating_point.h"

namespace corridor {

/// Half turns within this have no shorter way (design: «What an edge is»); radians.
inline constexpr double kHalfTurnBand = 1e-9;

/// The shorter way round a circle, radians, and how far rounding may have taken it off.
struct CircleTurn {
  double angle = 0;  ///< in [−π, π]
  double error = 0;

  /// Within the band, or the rounding of large angles, of a half turn.
  bool ambiguous() const { return !(std::abs(angle) + error <= std::numbers::pi - kHalfTurnBand); }
};

/// The shorter way from one angle to another, whatever their sizes; radians.
///
/// Error, with S = |from| + |to|: the difference rounds once, by 2^-53·S. Each of its turns, at
/// most S/2π + 1/2 ≤ S/π of them, is 2.5e-16 off 2π in double. Together that is below 2^-52·S;
/// doubled. Large angles go by their sines and cosines in long double, for which the C library
/// reduces them by as many digits of π as they need: 2^-58 of error, and the result rounds by
/// 2^-52.
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

/// An angle less whole turns, in [−π, π]: within 2^-53 of the real one, and rounded. (Up to 1,000
/// rad are 160 turns, each 2^-62 off 2π in long double.)
inline double intoCircle(double angle) {
  if (std::abs(angle) <= std::numbers::pi) return angle;
  using Real = long double;
  if (std::abs(angle) < 1000)
    return static_cast<double>(std::remainder(Real(angle), 2 * std::numbers::pi_v<Real>));
  return static_cast<double>(std::atan2(std::sin(Real(angle)), std::cos(Real(angle))));
}

}  // namespace corridor
