#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

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

/// The difference rounds once, 2^-53·S with S = |from| + |to|, and each of its turns, at most
/// S/2π + 1/2 ≤ S/π of them, is 2.5e-16 off 2π in double: below 2^-52·S together. Doubled.
inline CircleTurn circleTurn(double from, double to) {
  if (from == to) return {};
  const double turn = to - from;
  return {std::abs(turn) <= std::numbers::pi ? turn : std::remainder(turn, 2 * std::numbers::pi),
          0x1p-51 * (std::abs(from) + std::abs(to))};
}

/// Norm 1, whatever the size of the coefficients. @pre finite, not zero.
inline Eigen::Quaterniond unitQuaternion(const Eigen::Quaterniond& q) {
  const double squared = q.squaredNorm();
  if (squared > 1e-200 && squared < 1e200) return q.normalized();
  const Eigen::Vector4d scaled = q.coeffs() / q.coeffs().cwiseAbs().maxCoeff();
  return Eigen::Quaterniond(Eigen::Vector4d(scaled / scaled.norm()));
}

}  // namespace corridor
