#pragma once

#include <algorithm>
#include <cmath>

#include "collision/volumes/bounding_sphere.h"
#include "collision/volumes/overlap_obb_obb.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// Tests whether the distance of the centres exceeds the sum of the radii.
///
/// Derivation. Let x ↦ M x + t be the map from b's frame to a's, and η = ‖MᵀM − I‖_max. In frame A
/// the image of sphere b is within r_b(1 + 2η) of M c_B + t, since ‖M‖₂² ≤ 1 + 3η. The computed d =
/// M c_B + t − c_A is off by less than the margin `absolute` of `boxPairMargins`, 24u·S. The
/// computed |d| is off by another 4u·|d|. The margin `relative` of `boxPairMargins`, which exceeds
/// 12η + 200u, covers both 2η and 4u.
template <>
class PairTest<BoundingSphere> {
 public:
  PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB, double error)
      : X_AB_(X_AB), margins_(boxPairMargins(0, a.centerReach, 0, b.centerReach, X_AB)) {
    margins_.absolute += error;
  }

  bool separated(const BoundingSphere& a, const BoundingSphere& b, double pad) const {
    return distanceBound(a, b) > pad;
  }
  double distanceBound(const BoundingSphere& a, const BoundingSphere& b) const {
    const Vec3 centers = (X_AB_.m * b.center + X_AB_.t) - a.center;
    const double d = rootOrZero(centers.squaredNorm()), radii = a.size + b.size;
    const double gap = d - radii - margins_.relative * (d + radii) - margins_.absolute - kTiny;
    return gap > 0 && gap < HUGE_VAL ? roundedDown(gap) : 0;
  }

 private:
  Transform X_AB_;
  BoxPairMargins margins_;
};

}  // namespace corridor
