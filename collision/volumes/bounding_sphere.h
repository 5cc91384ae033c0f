#pragma once

#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// A sphere: {x : |x − center|₂ ≤ size}. Metres.
struct BoundingSphere {
  Vec3 center = Vec3::Zero();
  double size = 0;  ///< its radius

  static constexpr bool kOriented = false;
  /// Returns a sphere near the smallest one: the best of some steps of Bădoiu and Clarkson's
  /// iteration ("Smaller core-sets for balls", SODA 2003), which starts at the centre of the box.
  static BoundingSphere around(const Obb& box, const Content& content);
  Mat3 frameAxes() const { return Mat3::Identity(); }
  double axisDefect() const { return 0; }
  double centerReach() const { return roundedUp(center.stableNorm()); }
  double radius() const { return size; }
  const Vec3& ballCenter() const { return center; }
};

}  // namespace corridor
