#pragma once

#include <algorithm>
#include <cmath>

#include "collision/core/floating_point.h"

namespace corridor {

/// Unit roundoff u of double: |fl(x∘y) − x∘y| ≤ u·|x∘y| for + − × ÷ √, without underflow or
/// overflow.
inline constexpr double kUnit = 0x1p-53;

/// An upper bound of the error that underflow causes in a product of numbers below 2^20, with or
/// without flush-to-zero. The bound is far below the coordinates of any mesh.
inline constexpr double kTiny = 0x1p-1000;

/// Returns an upper bound of the real value of `bound`, if `bound` was computed from positive terms
/// with at most 16 roundings: (1 + u)^16 < 1 + 2^-48. Monotone; NaN stays NaN.
inline double roundedUp(double bound) {
  return bound * (1 + 0x1p-48) + kTiny;
}

/// Returns a + b if it is exact, else an upper bound of the real sum. NaN stays NaN. The error of a
/// sum is a double, and computed exactly (Dekker 1971, FastTwoSum). @pre a ≥ |b|, or b ≥ |a|.
inline double sumRoundedUp(double a, double b) {
  const double sum = a + b, error = std::min(a, b) - (sum - std::max(a, b));
  return error == 0 ? sum : roundedUp(sum);
}

/// Returns a lower bound of the real value of `bound`, if `bound` was computed from positive terms
/// with at most 16 roundings.
inline double roundedDown(double bound) {
  return bound * (1 - 0x1p-48) - kTiny;
}

/// Returns the square root of a computed sum of squares. Except for relative rounding errors, the
/// result is a lower bound of the root of the real sum. To this end, returns 0 if the sum is at
/// most 2^-960: rounding to subnormals may have made so small a sum too large.
inline double rootOrZero(double square) {
  return square > 0x1p-960 ? std::sqrt(square) : 0;
}

/// Returns the largest power of two that is at most `size`, clamped to [2^-1000, 2^1000]. If
/// lengths near `size` are measured in this unit, their squares neither overflow nor underflow.
/// Scaling by a power of two is exact. @pre `size` > 0.
inline double powerOfTwo(double size) {
  return std::ldexp(1.0, std::clamp(std::ilogb(size), -1000, 1000));
}

}  // namespace corridor
