#pragma once

#include <algorithm>
#include <cmath>

#include "collision/core/floating_point.h"

namespace corridor {

/// Unit roundoff of double: |fl(x∘y) − x∘y| ≤ u·|x∘y| for + − × ÷ √ where nothing under- or
/// overflows.
inline constexpr double kUnit = 0x1p-53;

/// Below what any underflow of a product of numbers under 2^20 can lose, flush-to-zero on or off;
/// far below any mesh.
inline constexpr double kTiny = 0x1p-1000;

/// A bound made of positive terms by at most 16 roundings, made safe: (1 + u)^16 < 1 + 2^-48.
/// Monotone, and NaN stays NaN.
inline double roundedUp(double bound) {
  return bound * (1 + 0x1p-48) + kTiny;
}

/// As above, downwards, for positive numbers.
inline double roundedDown(double bound) {
  return bound * (1 - 0x1p-48) - kTiny;
}

/// The root of a sum of squares as a lower bound: 0 where rounding to subnormals may have made it
/// larger.
inline double rootFromBelow(double square) {
  return square > 0x1p-960 ? std::sqrt(square) : 0;
}

/// The largest power of two below `size` > 0, within 2^±1000: a unit in which squares of what is of
/// that size neither over- nor underflow, exact to scale by.
inline double powerOfTwo(double size) {
  return std::ldexp(1.0, std::clamp(std::ilogb(size), -1000, 1000));
}

}  // namespace corridor
