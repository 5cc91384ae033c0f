#pragma once

#include "collision/core/transform.h"

/// The overlap test of wide trees: sixteen pairs of oriented boxes at once, in float
/// (`overlappingBoxes`, overlap_wide-inl.h), by the separating-axis theorem with all rounding in
/// the margins.
///
/// u = 2^-24; M, t, s take b's frame and unit to a's, in double, and M̂, t̂ are their floats. A box
/// of a is {c_a + A x, |x_i| ≤ a_i}, one of b {c_b + U y, |y_j| ≤ b_j}, in floats that are taken as
/// exact reals; their axes, orthonormal to 2^-40 before they were rounded, have defects η ≤ 2.1u;
/// |c| ≤ 3 (their corners are in the unit cube). In coordinates z = Aᵀ(x − c_a) box a is {AᵀA x},
/// inside the axis-aligned box of half extents a + η·Σa, and box b is {T + R y}, T = Aᵀ(sM c_b + t
/// − c_a), R = AᵀMU in real arithmetic. Computed:
///   p̂ = sM̂ c_b + t̂ − c_a: a coordinate is off by 6.2u·s|c_b| + 3.1u|t_i| + 1.1u|c_a|; as a ball
///       u·(33s + 3.1|t| + 6): absolute, told once a query. T's product 5.4u·|T|₁ more.
///   V̂ = M̂U: 4.1u an entry; R̂ = AᵀV̂: ε_R = √3·4.1u + 3.1u < 10.3u an entry.
///   η_R = ‖R̂ᵀR̂ − I‖_max ≤ 3(2η + η_M) + 2√3·ε_R < 49u + 3.1η_M.
/// Growth is moved to box a, as in overlap_obb_obb.h: then an exactly axis-aligned box and an exact
/// parallelepiped are asked along e_i, R̂_j, and e_i × R̂_j, where R̂_j × R̂_k = ±R̂_l but for 3η_R. A
/// projection and its radius take fewer than 12 roundings of numbers below |T|₁ + Σa + Σb. Times
/// this sum, the most that one term gets is Σb's: √3·ε_R + 3η_R + 13u < 178u + 9.3η_M. A ball's
/// radius is taken whole on cross axes, whose length is at most 1 + 2^-18. Underflow, flush to zero
/// included, loses less than 2^-118.
namespace corridor {

class WideObbTree;

/// What the float kernel reads.
struct FloatPose {
  float turn[3][3];    ///< M
  float scaled[3][3];  ///< s·M
  float offset[3];     ///< t
  float scale;         ///< s
  float relative;      ///< times (|T|₁ + Σa + Σb)
  float ball;          ///< of a's unit
};

/// How one wide tree lies relative to another: x_a = s·M·x_b + t between the trees' own coordinates
/// x = (p − origin)·2^-unit.
struct WidePose {
  /// By more than `pad`, as the spheres about the trees' origins tell; then nothing below is told.
  bool apart = false;
  Mat3 m = Mat3::Identity();
  Vec3 t = Vec3::Zero();
  double scale = 1;
  double unitA = 1;     ///< 2^-unit of a
  double shrink = 0;    ///< times a distance in a's frame is at most that in the world
  float leafError = 0;  ///< of a's unit, rounded up: how far a contact's two points may be apart
  FloatPose floats;

  /// `pad`: metres by which `apart` shall mean it.
  WidePose(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b, const Transform& X_WB,
           double pad);
};

}  // namespace corridor
