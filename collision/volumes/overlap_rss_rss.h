#pragma once

#include <algorithm>
#include <cmath>

#include "collision/volumes/overlap_obb_obb.h"
#include "collision/volumes/rss.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// Tests whether two rectangles are farther apart than the sum of their spheres' radii. The first
/// test treats the rectangles as flat boxes with 15 axes; it suffices if the closest features are a
/// face and a vertex, or two crossing edges. The second test is along the line between the closest
/// points. Alternating projections find these points (Cheney, Goldstein, Proc. AMS 10, 1959). The
/// proof is the projection of both rectangles onto the direction of that line. So if the
/// alternating projections have not converged, the proof is still valid, but the proved gap is
/// smaller.
///
/// Derivation. The derivation for boxes (overlap_obb_obb.h) holds, in the coordinates of rectangle
/// a. For a direction n, the gap is that of the two cores minus the radii times |n|. In these
/// coordinates the radii of the swept spheres are at most r_a(1 + 1.5η_A) and r_b(1 + 1.5η_A +
/// 2η_M). The factor 1 + `relative` covers both.
template <>
class PairTest<Rss> {
 public:
  PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB, double error)
      : X_AB_(X_AB),
        margins_(boxPairMargins(a.axisDefect, a.centerReach, b.axisDefect, b.centerReach, X_AB)) {
    margins_.absolute += error;
  }

  bool separated(const Rss& a, const Rss& b, double pad) const {
    const internal::BoxPair pair(a.core, b.core, X_AB_);
    const double radii = a.size + b.size;
    return internal::separated(pair, a.core.half, b.core.half, margins_,
                               roundedUp(pad + radii * (1 + margins_.relative))) ||
           alongClosest(pair, a.core.half, b.core.half, radii, pad, pad) > pad;
  }
  double distanceBound(const Rss& a, const Rss& b) const {
    const internal::BoxPair pair(a.core, b.core, X_AB_);
    const double radii = a.size + b.size;
    const double boxes = internal::boxDistanceBound(pair, a.core.half, b.core.half, margins_) -
                         roundedUp(radii * (1 + margins_.relative));
    return std::max({0.0, roundedDown(boxes),
                     alongClosest(pair, a.core.half, b.core.half, radii, 0, HUGE_VAL)});
  }

 private:
  static constexpr int kSteps = 8;

  /// Returns the largest gap proved along the directions that the alternating projections produce,
  /// or 0; metres. Stops at a gap above `enough`, when a point of each rectangle is found such that
  /// both points are at most radii + pad apart, or after `kSteps` projections.
  double alongClosest(const internal::BoxPair& pair, const Vec3& a, const Vec3& b, double radii,
                      double pad, double enough) const {
    const double slack = margins_.relative * (pair.T.cwiseAbs().sum() + a.sum() + b.sum() + radii) +
                         margins_.absolute + radii + kTiny;
    // If a map is far from rigid, 1 − relative could be negative and would change the sign of the
    // gap.
    if (!(slack < HUGE_VAL && margins_.relative < 1)) return 0;
    double best = 0;
    Vec3 q = pair.T;  // a point of b
    for (int step = 0; step < kSteps; ++step) {
      const Vec3 p = q.cwiseMax(-a).cwiseMin(a);
      const Vec3 y = pair.R.transpose() * (p - pair.T);
      q = pair.T + pair.R * y.cwiseMax(-b).cwiseMin(b);
      const Vec3 n = q - p;
      const double length = rootOrZero(n.squaredNorm());
      if (!(length > radii + pad)) break;
      const double gap = (n.dot(pair.T) - n.cwiseAbs().dot(a) -
                          (pair.R.transpose() * n).cwiseAbs().dot(b) - kTiny) /
                             length -
                         slack;
      if (gap < HUGE_VAL) best = std::max(best, roundedDown(gap * (1 - margins_.relative)));
      if (best > enough) break;
    }
    return best;
  }

  Transform X_AB_;
  BoxPairMargins margins_;
};

}  // namespace corridor
