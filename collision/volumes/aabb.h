#pragma once

#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// An axis-aligned box in the frame of its mesh: {center + x : |x_i| ≤ half_i}. Metres.
struct Aabb {
  Vec3 center = Vec3::Zero();
  Vec3 half = Vec3::Zero();

  static constexpr bool kOriented = false;
  static Aabb around(const Obb& box, const Content&) { return {box.center, box.half}; }
  Mat3 frameAxes() const { return Mat3::Identity(); }
  double axisDefect() const { return 0; }
  double centerReach() const { return roundedUp(center.stableNorm()); }
  double radius() const { return roundedUp(half.stableNorm()); }
};

}  // namespace corridor
