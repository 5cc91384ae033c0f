#pragma once

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// An axis-aligned box in the frame of its mesh: {center + x : |x_i| ≤ half_i}. Metres.
struct Aabb {
  Vec3 center = Vec3::Zero();
  Vec3 half = Vec3::Zero();

  static constexpr bool kOriented = false;
  static Aabb around(const Obb& box, const Content&) { return {box.center, box.half}; }
  /// Returns a box around both boxes. Up to rounding, it is as tight as a box fitted to the
  /// contents of both.
  static Aabb merged(const Aabb& a, const Aabb& b) {
    const Vec3 low = (a.center - a.half).cwiseMin(b.center - b.half),
               high = (a.center + a.half).cwiseMax(b.center + b.half);
    Aabb both{low + 0.5 * (high - low), Vec3::Zero()};
    for (int i = 0; i < 3; ++i)
      both.half[i] = roundedUp(std::max(std::abs(a.center[i] - both.center[i]) + a.half[i],
                                        std::abs(b.center[i] - both.center[i]) + b.half[i]));
    return both;
  }
  Mat3 frameAxes() const { return Mat3::Identity(); }
  double axisDefect() const { return 0; }
  double centerReach() const { return roundedUp(center.stableNorm()); }
  double radius() const { return roundedUp(half.stableNorm()); }
  const Vec3& ballCenter() const { return center; }
};

}  // namespace corridor
