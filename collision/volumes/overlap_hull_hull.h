#pragma once

#include "collision/volumes/hull.h"
#include "collision/volumes/overlap_sphere_sphere.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// Tests the spheres around two hulls, then searches for a direction that separates the hulls
/// (direction_search.h). The proof is the projection of all vertices onto that direction.
///
/// Derivation. For a direction n with |n| ≤ 1 + 5u the gap is min (Mᵀn)·q + n·t − max n·p over the
/// vertices p of a and q of b, minus the radii times |n| and |Mᵀn|. With F = ‖M‖_F and ρ_A, ρ_B the
/// largest |p| and |q|, the rounding is at most:
/// * Mᵀn: 3.1uF, which changes its product with q by 3.1uFρ_B. The product itself: 3.1uFρ_B. n·t:
///   3.1u|t|. n·p: 3.1uρ_A.
/// * three sums: 4u(ρ_A + Fρ_B + |t|).
///
/// The total is below 12u(ρ_A + Fρ_B + |t|). The slack, computed once per query, has 16u instead of
/// 12u. The additional 4u cover two more terms: the roundings of the slack itself, and 5u·`error`,
/// because |n| may exceed 1. (A gap can only be proved if `error` < |t| + ρ_A + 1.001ρ_B. F is at
/// least 1.7.) The radii get the factor 1 + `relative` of `boxPairMargins`, as for `Rss`.
/// `roundedDown` covers the division by |n|.
template <>
class PairTest<Hull> {
 public:
  PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB, double error);

  bool separated(const Hull& a, const Hull& b, double pad) const;
  double distanceBound(const Hull& a, const Hull& b) const;

 private:
  double alongDirections(const Hull& a, const Hull& b, double pad, double enough,
                         double agreed) const;

  Transform X_AB_;
  PairTest<BoundingSphere> spheres_;
  double relative_, slack_;
};

}  // namespace corridor
