#pragma once

#include <cstdint>

/// The overlap test of 4-wide OBB trees: sixteen pairs of oriented boxes at once, in float
/// (overlap_obb4_obb4-inl.h), by the separating-axis theorem. All rounding is in the margins.
///
/// Derivation. u = 2^-24. The map x ↦ s·M x + t, in double, takes b's frame and unit to a's, with s
/// a power of two. M̂ and t̂ are M and t rounded to float. A box of a is {c_a + A x, |x_i| ≤ a_i},
/// a box of b is {c_b + U y, |y_j| ≤ b_j}; their floats are taken as exact reals. Axes were
/// orthonormal to 2^-40 before they were rounded to float, so their defects η are at most 2.1u. η_M
/// is the defect of M. |c| ≤ 3, since the content is in the cube [−1, 1]³.
///
/// In coordinates z = Aᵀ(x − c_a), box a is {AᵀA x}, which is inside the axis-aligned box of half
/// extents a + η·Σa. Box b is {T + R y} with T = Aᵀ(sM c_b + t − c_a), R = AᵀMU, in real
/// arithmetic. The code computes, with these errors:
///   p̂ = s(M̂ c_b) + t̂ − c_a: a coordinate is off by 6.2u·s|c_b| + 3.1u|t_i| + 1.1u|c_a|. As a
///       sphere's radius this error is u·(33s + 3.1|t| + 6), computed once per query. The product
///       Aᵀp̂ adds an error of 5.4u·|T|₁ to T.
///   V̂ = M̂U: 4.1u per entry; R̂ = AᵀV̂: ε_R = √3·4.1u + 3.1u < 10.3u per entry.
///   η_R = ‖R̂ᵀR̂ − I‖_max ≤ 3(2η + η_M) + 2√3·ε_R < 49u + 3.1η_M.
/// All growth is moved to box a, as in overlap_obb_obb.h. It remains to test an exactly
/// axis-aligned box and an exact parallelepiped along e_i, R̂_j, and e_i × R̂_j, where R̂_j × R̂_k
/// = ±R̂_l up to 3η_R. A projection and its radius take fewer than 12 roundings (fewer still if
/// fused) of numbers below |T|₁ + Σa + Σb. `relative` is the factor of this sum. This factor must
/// exceed the factor of every single term; the largest is that of Σb: √3·ε_R + 3η_R + 13u < 178u +
/// 9.3η_M. On cross axes, whose length is at most 1 + 2^-18, the whole radius of the sphere is
/// added. Underflow, flush to zero included, loses less than 2^-118.
namespace corridor {

/// Four oriented boxes {center + Σ_j axis_j·x_j : |x_j| ≤ half_j}, in real arithmetic on the floats
/// stored. The four values of a row are contiguous. Axes were orthonormal to 2^-40 before they were
/// rounded to float. The content of the boxes is in the cube [−1, 1]³.
struct alignas(16) Obb4 {
  static constexpr int kCenter = 3;
  float vectors[3][4][4];  ///< [k][j]: component k of axis j, or of the centre (j = kCenter)
  float half[3][4];
};

/// One box in float, as in `Obb4`, laid out for four lanes: axis j is column j of `vectors`, and
/// the centre is column 3.
struct alignas(16) Obb1 {
  float vectors[3][4];  ///< [k][j]
  float half[4];        ///< half[3] is 0
};
inline Obb1 boxOf(const Obb4& four, std::uint32_t lane) {
  Obb1 box = {};
  for (int j = 0; j < 3; ++j) box.half[j] = four.half[j][lane];
  for (int j = 0; j < 4; ++j)
    for (int k = 0; k < 3; ++k) box.vectors[k][j] = four.vectors[k][j][lane];
  return box;
}

/// The pose of b's frame in a's frame, with the margins of the overlap test.
struct alignas(16) Obb4Pose {
  float turn[3][4];      ///< [j][k]: component k of column j of M; k = 3 is unused
  float offset[4];       ///< t, in a's unit; the last entry is unused
  float scale;           ///< s, a power of two
  float relative;        ///< margin as a factor of (|T|₁ + Σa + Σb)
  float absoluteMargin;  ///< margin as the radius of a sphere, in a's unit
};

/// Motion bounds of four boxes of b in a time interval, relative to the middle of the interval
/// (`RelativeMotion` defines the motion). A point x of box j moves to x + s·(linear_j + angular ×
/// (x − c_j)) + remainder, |s| ≤ 1. Along any vector n, |n·remainder| ≤ secondOrderAcross_j·|n ×
/// angular| + secondOrder_j·|n|, and no point moves farther than isotropic_j. pad_j is all other
/// distance that the pair must keep, such as the radius of the tube and the margin. Values are in
/// a's unit and frame. All bounds are rounded up, and are at least (1 + 2^-16) times the true bound
/// in a's frame, which covers the defects of a's axes.
///
/// Derivation of the test. In the coordinates of a's box that are defined above, a point T + R y of
/// box b moves by s·(V + W × R y) and a remainder, with V = Aᵀlinear and W = Aᵀangular, up to
/// 3η|W||y| for A's defect. Along a unit vector n the first-order motion is at most |n·V| + Σ_k b_k
/// |R_k·(n × W)|, and
///   n = e_i:        R_k·(e_i × W) = R_(i+2)k W_(i+1) − R_(i+1)k W_(i+2), exactly;
///   n = R_j:        R_k·(R_j × W) = ±W·R_l, l the third of j, k, l, up to 3η_R|W|;
///   n = e_i × R_j:  R_k·(n × W) = W_i (R_j·R_k) − R_ik (W·R_j), where R_j·R_k = δ_jk up to η_R.
/// Coordinates of V and W round like those of T: each is off by less than 6u times the length of
/// its vector, and each entry of R by ε_R. Each of the sums above is therefore off by less than
///   (3η_R + 3η + 2·√3·ε_R + 20u)·|W|(Σb + secondOrderAcross) + 40u·(|V| + secondOrder + pad).
/// The first factor is at most 209u + 10η_M. The code uses twice `relative` instead, and `relative`
/// is 180u + 10η_M. If V is small relative to the terms of which it is the sum, the rounding of
/// this sum in double matters; `secondOrder` includes that rounding.
struct Obb4MotionBound {
  float linear[3][4];  ///< to first order, the boxes' centres move by s·linear
  float angular[3];    ///< radians; half of the interval's rotation
  float secondOrderAcross[4], secondOrder[4], isotropic[4], pad[4];
};

}  // namespace corridor
