#pragma once

#include <Eigen/Geometry>

#include "collision/volumes/overlap_obb_obb.h"

namespace corridor::internal {

/// A pair of boxes, with a test that proves separation along a given direction. The test does not
/// depend on how the direction was found.
///
/// In the coordinates of box a (overlap_obb_obb.h), the test proves for a direction L that the
/// axis-aligned box {|x_i| ≤ a_i} and the exact parallelepiped {T + R y, |y_j| ≤ b_j} are more than
/// `margin` apart along L. `margin` is the absolute margin plus `pad` plus `slack`; `slack` covers
/// all growth and rounding. For any L the gap |L·T| − Σ a_i|L_i| − Σ b_j|L·R_j| uses no
/// orthogonality. Growth by a sphere of radius ρ costs ρ|L|. Evaluating the gap takes 11 roundings
/// of terms whose sum is below |L|(|T|₁ + Σa + Σb): `slack` includes 16u times that sum. L is
/// scaled to a largest entry of 1, so that kTiny covers underflow. The proof is for the scaled and
/// rounded direction.
struct DirectedBoxes : BoxPair {
  const Vec3 &a, &b;
  double slack, margin;

  DirectedBoxes(const Obb& boxA, const Obb& boxB, const Transform& X_AB,
                const BoxPairMargins& margins, double pad)
      : BoxPair(boxA, boxB, X_AB),
        a(boxA.half),
        b(boxB.half),
        slack(margins.relative * (size() + pad) + kTiny),
        margin(margins.absolute + pad + slack) {}

  double size() const { return T.cwiseAbs().sum() + a.sum() + b.sum(); }

  /// Returns true if the boxes are proved to be more than `margin` apart along L.
  /// @param L  the direction; its largest entry is ±1
  /// @param L_B  Rᵀ L
  bool apartAlong(const Vec3& L, const Vec3& L_B) const {
    const double gap = std::abs(L.dot(T)) - L.cwiseAbs().dot(a) - L_B.cwiseAbs().dot(b);
    return gap > margin && gap > margin * (L.norm() * (1 + 4 * kUnit));  // |L| ≥ 1
  }
  bool apartAlong(const Vec3& direction) const {
    const Vec3 L = direction / direction.cwiseAbs().maxCoeff();
    return apartAlong(L, R.transpose() * L);
  }
  /// Returns true if `apartAlong` proves separation along one of the 15 axes. Used for the few
  /// pairs for which rounding made a search fail.
  bool apartAlongAny() const {
    for (int i = 0; i < 3; ++i)
      if (apartAlong(Vec3::Unit(i)) || apartAlong(R.col(i))) return true;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (apartAlong(Vec3::Unit(i).cross(R.col(j)))) return true;
    return false;
  }
};

}  // namespace corridor::internal
