#include "collision/hierarchy/wide_pose.h"

#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/volumes/obb.h"

namespace corridor {
WidePose::WidePose(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b,
                   const Transform& X_WB, double pad) {
  // With the trees' origins o: y = M_A⁻¹(M_B x + D), D = M_B o_B + t_B − M_A o_A − t_A. M_A⁻¹ is
  // replaced by M_Aᵀ: M_A⁻¹ − M_Aᵀ = (I − M_AᵀM_A) M_A⁻¹, of norm ≤ 3η_A/√(1 − 3η_A).
  const Vec3 D = (X_WB * b.origin()) - (X_WA * a.origin());
  const double defectA = orthonormalityDefect(X_WA.m), defectB = orthonormalityDefect(X_WB.m);
  // Maps of greater defect prune nothing, nor do boxes of meshes above 2^960 m, which the tree's
  // unit doesn't bring into [−1, 1] from 2^1000 on; an entry of m·unitA that is flushed would move
  // b by 2^-1022·unitA⁻¹ of itself, more than the margins have left. NaN: not usable.
  const bool usable =
      defectA < 0x1p-6 && defectB < 0x1p-6 && a.length() <= 0x1p960 && b.length() <= 0x1p960;
  // D has at most five roundings of terms that sum up to `terms` over its coordinates; |M_ij|
  // ≤ 1.1.
  const double terms = 3.4 * (b.origin().cwiseAbs().sum() + a.origin().cwiseAbs().sum()) +
                       X_WB.t.cwiseAbs().sum() + X_WA.t.cwiseAbs().sum();
  // |M x| ≤ √(1 + 3η)|x| ≤ (1 + 1.5η)|x|.
  const double spheres = roundedUp(a.radius() * (1 + 1.5 * defectA) +
                                   b.radius() * (1 + 1.5 * defectB) + 6 * kUnit * terms + pad);
  apart = usable && D.squaredNorm() * (1 - 0x1p-48) > spheres * spheres * (1 + 0x1p-48) + kTiny;
  if (apart) return;
  m.noalias() = X_WA.m.transpose().lazyProduct(X_WB.m);
  const Vec3 offset = X_WA.m.transpose() * D;
  // |MᵀM − I| entry by entry, of M = M_AᵀM_B: that of B and ‖M_B‖²‖M_A M_Aᵀ − I‖, which is ‖M_AᵀM_A
  // − I‖ ≤ 3η_A; and m's rounding, 3.1u·√3 an entry, twice √3 times.
  const double defect = defectB + 3.2 * defectA + 24 * kUnit;
  // Entries of m and of the offset, three products and two sums each: 3.1u·3 as a norm.
  const double reach = 1.1 * b.radius() + D.cwiseAbs().sum();
  // Differences and products that underflow, flushed to zero, lose less than 2^-1018.
  const double metres =
      1.2 * ((3.1 * defectA + 32 * kUnit) * reach + 6 * kUnit * terms) + 0x1p-1015;
  unitA = 1 / a.length();
  scale = b.length() * unitA;  // powers of two; 0 or infinite where it is out of range
  t = offset * unitA;
  const double error = usable ? metres * unitA : HUGE_VAL;
  constexpr double u = 0x1p-24;
  floats.relative = static_cast<float>(180 * u + 10 * defect);
  // Rounded up, for the conversion and for the length of cross axes.
  floats.ball = static_cast<float>(
      (error + u * (33 * scale + 3.1 * t.cwiseAbs().sum() + 6) + 0x1p-118) * (1 + 0x1p-16));
  // |M_A x| ≥ √(1 − 3η)·|x| ≥ (1 − 3η)|x|.
  shrink = usable ? roundedDown(1 - 3.1 * defectA) : 0;
  leafError = static_cast<float>(error * (1 + 0x1p-20) + 0x1p-118);
  floats.scale = static_cast<float>(scale);
  for (int i = 0; i < 3; ++i) {
    floats.offset[i] = static_cast<float>(t[i]);
    for (int j = 0; j < 3; ++j) floats.turn[i][j] = static_cast<float>(m(i, j));
  }
}

}  // namespace corridor
