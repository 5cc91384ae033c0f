#pragma once

#include "collision/volumes/ellipsoid.h"
#include "collision/volumes/overlap_obb_obb.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// Searches for a direction along which two ellipsoids are separated, first along the line of the
/// centres, then by the contact function of J. W. Perram and M. S. Wertheim ("Statistical mechanics
/// of hard ellipsoids", J. Comp. Phys. 58, 1985). Let A and B be the matrices of the ellipsoids
/// xᵀA⁻¹x ≤ 1, and T the vector between the centres. The function S(s) = s(1 − s) TᵀG⁻¹T with G =
/// (1 − s)A + sB is concave on [0, 1], and its maximum is above 1 if and only if the ellipsoids are
/// disjoint. Then n = G⁻¹T at the maximum separates them. The search narrows an interval of s that
/// contains the maximum. The search ends if S, up to rounding, is at most 1 on this interval.
///
/// The search proves nothing. The proof is the projection of both sets onto the direction that the
/// search finds.
///
/// Derivation. The derivation for boxes (overlap_obb_obb.h) holds, in the coordinates of ellipsoid
/// a: each of its bounds is a bound for the points of a box, and an ellipsoid is in its box. For a
/// direction n the gap is n·T − |D_a n| − |D_b Rᵀn| minus the radii times |n|, with D_a and D_b the
/// diagonal matrices of the semi-axes. This formula uses no orthogonality. Computing the gap takes
/// 14 roundings of terms whose sum is below |n|(|T|₁ + Σa + Σb), and `relative` includes 16u for
/// them. The radii of the swept spheres grow by at most the factor 1 + `relative`, as for `Rss`.
/// Directions have a largest entry of at least 1/2. Underflow takes less than 2^-1020 from each sum
/// of squares, so each of the two norms is too small by less than 2^-510. The term 2^-500 in the
/// gap covers this and the underflow of products.
template <>
class PairTest<Ellipsoid> {
 public:
  PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB, double error)
      : X_AB_(X_AB),
        margins_(boxPairMargins(a.axisDefect, a.centerReach, b.axisDefect, b.centerReach, X_AB)) {
    margins_.absolute += error;
  }

  bool separated(const Ellipsoid& a, const Ellipsoid& b, double pad) const;
  double distanceBound(const Ellipsoid& a, const Ellipsoid& b) const;

 private:
  Transform X_AB_;
  BoxPairMargins margins_;
};

}  // namespace corridor
