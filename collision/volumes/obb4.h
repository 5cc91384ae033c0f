#pragma once

#include <cstdint>

/// The overlap test of wide trees: sixteen pairs of oriented boxes at once, in float
/// (overlap_obb4_obb4-inl.h), by the separating-axis theorem with all rounding in
/// the margins.
///
/// u = 2^-24; M, t, s take b's frame and unit to a's, in double, and M̂, t̂ are their floats. A box
/// of a is {c_a + A x, |x_i| ≤ a_i}, one of b {c_b + U y, |y_j| ≤ b_j}, in floats that are taken as
/// exact reals; their axes, orthonormal to 2^-40 before they were rounded, have defects η ≤ 2.1u;
/// |c| ≤ 3 (what they hold is in the cube [−1, 1]³). In coordinates z = Aᵀ(x − c_a) box a is {AᵀA
/// x}, inside the axis-aligned box of half extents a + η·Σa, and box b is {T + R y}, T = Aᵀ(sM c_b
/// + t − c_a), R = AᵀMU in real arithmetic. Computed:
///   p̂ = s(M̂ c_b) + t̂ − c_a: a coordinate is off by 6.2u·s|c_b| + 3.1u|t_i| + 1.1u|c_a|; as a ball
///       u·(33s + 3.1|t| + 6): absolute, told once a query. T's product 5.4u·|T|₁ more.
///   V̂ = M̂U: 4.1u an entry; R̂ = AᵀV̂: ε_R = √3·4.1u + 3.1u < 10.3u an entry.
///   η_R = ‖R̂ᵀR̂ − I‖_max ≤ 3(2η + η_M) + 2√3·ε_R < 49u + 3.1η_M.
/// Growth is moved to box a, as in overlap_obb_obb.h: then an exactly axis-aligned box and an exact
/// parallelepiped are asked along e_i, R̂_j, and e_i × R̂_j, where R̂_j × R̂_k = ±R̂_l but for 3η_R. A
/// projection and its radius take fewer than 12 roundings (fused, fewer still) of numbers below
/// |T|₁ + Σa + Σb. Times this sum, the most that one term gets is Σb's: √3·ε_R + 3η_R + 13u < 178u
/// + 9.3η_M. A ball's radius is taken whole on cross axes, whose length is at most 1 + 2^-18.
/// Underflow, flush to zero included, loses less than 2^-118.
namespace corridor {

/// Four oriented boxes {center + Σ_j axis_j·x_j : |x_j| ≤ half_j}, for the floats stored as exact
/// reals; the four of a row are contiguous. Their axes were orthonormal to 2^-40 before they were
/// rounded to float; what they hold is in the cube [−1, 1]³.
struct alignas(16) Obb4 {
  static constexpr int kCenter = 3;
  float vectors[3][4][4];  ///< [k][j]: component k of axis j, or of the centre (j = kCenter)
  float half[3][4];
};

/// One such box, laid out for four lanes: axis j is column j of `vectors`, the centre column 3.
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

/// How b's frame lies in a's, and the margins: what the test reads.
struct alignas(16) Obb4Pose {
  float turn[3][4];  ///< [j][k]: component k of M's column j; the last of a row is nothing
  float offset[4];   ///< t
  float scale;       ///< s, a power of two
  float relative;    ///< times (|T|₁ + Σa + Σb)
  float ball;        ///< of a's unit
};

/// How four boxes b move in a window of time, told at its middle (`MotionWindow` says of what): a
/// point x of the j-th goes to x + s·(linear_j + angular × (x − c_j)) + remainder, |s| ≤ 1, where
/// along any vector n |n·remainder| ≤ bend_j·|n × angular| + curvature_j·|n|, and never farther
/// than cap_j; pad_j is what it may be off besides. In a's unit and frame; all that bounds is
/// rounded up, and at least (1 + 2^-16) times what it is in A, for the defects of axes.
///
/// Derivation of the test with it. In coordinates of a's box (above) a point T + R y of box b goes
/// by s·(V + W × R y) and a remainder, V = Aᵀlinear, W = Aᵀangular but for 3η|W||y| of A's defect.
/// Along a unit vector n that is at most |n·V| + Σ_k b_k |R_k·(n × W)|, and
///   n = e_i:        R_k·(e_i × W) = R_(i+2)k W_(i+1) − R_(i+1)k W_(i+2), as written;
///   n = R_j:        R_k·(R_j × W) = ±W·R_l, l the third of j, k, l, but for 3η_R|W|;
///   n = e_i × R_j:  R_k·(n × W) = W_i (R_j·R_k) − R_ik (W·R_j), where R_j·R_k = δ_jk but for η_R.
/// V's and W's coordinates round as T's do: each is off by less than 6u of its vector, R by ε_R. So
/// all these are off by less than (3η_R + 3η + 2·√3·ε_R + 20u)·|W|(Σb + bend) + 40u·(|V| +
/// curvature + pad), that is 209u + 10η_M times |W|(Σb + bend), of which `relative`, 180u + 10η_M,
/// has twice.
/// What V is off by in double, where it is small beside its terms, is in `curvature`.
struct Obb4Travel {
  float linear[3][4];  ///< of the centres, to first order
  float angular[3];    ///< radians; half the window's rotation
  float bend[4], curvature[4], cap[4], pad[4];
};

}  // namespace corridor
