#pragma once

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"
#include "collision/volumes/volume.h"

/// Box against box by the separating-axis theorem, 15 axes (Gottschalk, Lin, Manocha 1996, section
/// 5). The result `true` is a proof that the boxes, as the sets that `Obb` defines in real
/// arithmetic, are apart by more than the requested margin. The result `false` proves nothing.
/// Every rounding error is inside the margins.
///
/// Derivation. Let A be the frame of box a, and x ↦ M x + t the map from b's frame (doubles, taken
/// as exact). In coordinates y = U_Aᵀ(x − c_A), box a is {U_AᵀU_A x}, which is inside the
/// axis-aligned box of half extents a + η_A·Σa. Box b is {T + R x} with T = U_Aᵀ(M c_B + t − c_A),
/// R = U_Aᵀ M U_B in real arithmetic. η_A, η_B and η_M are the defects of U_A, U_B and M from
/// orthonormal matrices. The computed T̂, R̂ are off by at most ε_T and ε_R per coordinate. So box
/// b is inside {T̂ + R̂ x} grown by ε_T + ε_R·Σb per coordinate. That growth is added to box a
/// instead of box b. It remains to test whether an exactly axis-aligned box and an exact
/// parallelepiped, given by doubles, are apart. Any direction L may be used:
///   L = e_i:        radius of a: a_i; of b: Σ b_k |R̂_ik|. Both need no orthogonality.
///   L = R̂_j:        of a: Σ a_i |R̂_ij|; of b: Σ b_k |R̂_j·R̂_k| ≤ b_j + η_R Σ b_k.
///   L = e_i × R̂_j:  of a: as written; of b: Σ b_k |e_i·(R̂_j × R̂_k)|, where R̂_j × R̂_k = ±R̂_l up to
///                   3η_R.
/// Here η_R = ‖R̂ᵀR̂ − I‖_max ≤ 3(η_A + η_B + η_M) + 64u up to second order. For RᵀR = U_BᵀMᵀ(U_A
/// U_Aᵀ)M U_B, each defect E enters as xᵀE y ≤ ‖E‖₂ ≤ 3‖E‖_max for unit x, y, and ε_R adds
/// 2·√3·12u. Growth by a sphere of radius ρ adds ρ|L|. A projection and its radius take fewer than
/// 12 roundings of numbers below |T|₁ + Σa + Σb (|R̂_ij| < 1 + 2^-20): 16u of that sum. All of this
/// is in `BoxPairMargins`, computed once per query.
namespace corridor {

/// Margins that hold for all pairs of boxes of two trees under one relative map.
struct BoxPairMargins {
  double relative = 0;  ///< slack of every axis, as a factor of (|T|₁ + Σa + Σb)
  /// Metres: the sum of ε_T and of the errors that the caller adds (of poses), as the radius of a
  /// sphere.
  double absolute = 0;
};

/// Returns the margins of two trees under the map X_AB. `defectA` and `defectB` bound the defects
/// of their axes, `reachA` and `reachB` the distances of their box centres from their frames'
/// origins (metres).
inline BoxPairMargins boxPairMargins(double defectA, double reachA, double defectB, double reachB,
                                     const Transform& X_AB) {
  // ε_R: an entry of R̂ is two nested sums of three products of unit vectors' entries. It takes 6
  // roundings with Σ|·||·| ≤ √3: 12u. ε_T: M c_B + t − c_A has at most 5 roundings of terms below S
  // = reachB + |t| + reachA per coordinate, and the product with U_Aᵀ 3 more. That is (5√3 +
  // 3)·u·S·1.01 < 12u·S per coordinate. As the radius of a sphere it is √3 times as much: below
  // 24u·S.
  const double defectM = orthonormalityDefect(X_AB.m);
  const double defectR = 3 * (defectA + defectB + defectM) + 64 * kUnit;
  BoxPairMargins margins;
  // The terms are, in this order: the growth by η_A·Σa and by ε_R·Σb (as spheres: times √3 < 2),
  // then 3η_R·Σb, then rounding.
  margins.relative = roundedUp(2 * defectA + 24 * kUnit + 4 * defectR + 16 * kUnit);
  margins.absolute = roundedUp(24 * kUnit * (reachA + reachB + X_AB.t.cwiseAbs().sum()));
  // If a matrix is far from a rotation, the omitted second-order terms are not small. Then no box
  // is ever separated.
  if (!(defectR < 0x1p-10)) margins.absolute = HUGE_VAL;
  return margins;
}

namespace internal {

/// Returns √(x² + y²). `std::hypot` would guard against overflow, at ten times the cost. Here x and
/// y are entries of rotations, so there is no overflow.
template <class Number>
Number length(Number x, Number y) {
  using std::sqrt;
  return sqrt(x * x + y * y);
}

/// A pair of boxes in the coordinates of box a.
struct BoxPair {
  Mat3 R, absR;
  Vec3 T;
  BoxPair(const Obb& a, const Obb& b, const Transform& X_AB)
      : R(a.axes.transpose() * (X_AB.m * b.axes)),
        absR(R.cwiseAbs()),
        T(a.axes.transpose() * ((X_AB.m * b.center + X_AB.t) - a.center)) {}
};

/// Returns true if the boxes are proved to be more than `pad` apart. `Pair` has the members R, absR
/// and T of `BoxPair`. Their numbers are doubles, or numbers that count operations (benchmarks).
template <class Pair, class Vector>
bool separated(const Pair& pair, const Vector& a, const Vector& b, const BoxPairMargins& margins,
               double pad) {
  using Number = typename Vector::Scalar;
  using std::abs;
  const auto &R = pair.R, &Q = pair.absR;
  const auto& T = pair.T;
  const Number slack = margins.relative * (T.cwiseAbs().sum() + a.sum() + b.sum() + pad) + kTiny;
  const double ball = margins.absolute + pad;
  for (int i = 0; i < 3; ++i) {
    const Number gap =
        abs(T[i]) - (a[i] + Q(i, 0) * b[0] + Q(i, 1) * b[1] + Q(i, 2) * b[2]) - ball - slack;
    if (gap > 0) return true;
  }
  for (int j = 0; j < 3; ++j) {
    const Number gap = abs(T[0] * R(0, j) + T[1] * R(1, j) + T[2] * R(2, j)) -
                       (b[j] + Q(0, j) * a[0] + Q(1, j) * a[1] + Q(2, j) * a[2]) - ball - slack;
    if (gap > 0) return true;
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const Number gap =
          abs(T[i2] * R(i1, j) - T[i1] * R(i2, j)) -
          (a[i1] * Q(i2, j) + a[i2] * Q(i1, j) + b[j1] * Q(i, j2) + b[j2] * Q(i, j1)) - slack;
      if (gap > 0 && gap > ball * length(R(i1, j), R(i2, j))) return true;
    }
  }
  return false;
}

/// Returns a lower bound of the distance of two boxes. The three axes of either box are orthogonal
/// up to their defects, so the root of the summed squares of the gaps along them is a lower bound.
/// The gap along a single edge axis is a lower bound, too. In the coordinates of box a distances
/// are those of frame A times (1 ± 1.5η_A), and along the R̂_j times (1 ± 1.5η_R); both changes are
/// less than `relative`. Every gap is computed as in `separated`.
template <class Pair>
double boxDistanceBound(const Pair& pair, const Vec3& a, const Vec3& b,
                        const BoxPairMargins& margins) {
  const Mat3 &R = pair.R, &Q = pair.absR;
  const Vec3& T = pair.T;
  const double slack =
      margins.relative * (T.cwiseAbs().sum() + a.sum() + b.sum()) + kTiny + margins.absolute;
  double squareA = 0, squareB = 0, edge = 0;
  for (int i = 0; i < 3; ++i) {
    const double gap =
        std::abs(T[i]) - (a[i] + Q(i, 0) * b[0] + Q(i, 1) * b[1] + Q(i, 2) * b[2]) - slack;
    if (gap > 0) squareA += gap * gap;
  }
  for (int j = 0; j < 3; ++j) {
    const double gap = std::abs(T[0] * R(0, j) + T[1] * R(1, j) + T[2] * R(2, j)) -
                       (b[j] + Q(0, j) * a[0] + Q(1, j) * a[1] + Q(2, j) * a[2]) - slack;
    if (gap > 0) squareB += gap * gap;
  }
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double l = length(R(i1, j), R(i2, j));
      if (l < 0x1p-20) continue;  // nearly parallel edges: the face axes give better bounds
      const double gap =
          std::abs(T[i2] * R(i1, j) - T[i1] * R(i2, j)) -
          (a[i1] * Q(i2, j) + a[i2] * Q(i1, j) + b[j1] * Q(i, j2) + b[j2] * Q(i, j1)) - slack;
      edge = std::max(edge, gap / l);
    }
  }
  const double bound = std::max(edge, rootOrZero(std::max(squareA, squareB)));
  return bound < HUGE_VAL ? std::max(0.0, roundedDown(bound * (1 - margins.relative))) : 0;
}

}  // namespace internal

/// Returns true if the boxes are proved to be more than `pad` metres apart.
inline bool obbsSeparated(const Obb& a, const Obb& b, const Transform& X_AB,
                          const BoxPairMargins& margins, double pad) {
  return internal::separated(internal::BoxPair(a, b, X_AB), a.half, b.half, margins, pad);
}

template <>
class PairTest<Obb> {
 public:
  PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB, double error)
      : X_AB_(X_AB),
        margins_(boxPairMargins(a.axisDefect, a.centerReach, b.axisDefect, b.centerReach, X_AB)) {
    margins_.absolute += error;
  }

  bool separated(const Obb& a, const Obb& b, double pad) const {
    return obbsSeparated(a, b, X_AB_, margins_, pad);
  }
  double distanceBound(const Obb& a, const Obb& b) const {
    return internal::boxDistanceBound(internal::BoxPair(a, b, X_AB_), a.half, b.half, margins_);
  }

 protected:
  Transform X_AB_;
  BoxPairMargins margins_;
};

}  // namespace corridor
