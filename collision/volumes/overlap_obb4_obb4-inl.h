// Four oriented boxes against four, for every SIMD target: included once per target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_OVERLAP_OBB4_OBB4_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_OVERLAP_OBB4_OBB4_INL_H_
#undef CORRIDOR_OVERLAP_OBB4_OBB4_INL_H_
#else
#define CORRIDOR_OVERLAP_OBB4_OBB4_INL_H_
#endif
// clang-format on

#include <cstdint>

#include "hwy/highway.h"

#include "collision/volumes/obb4.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Lane l is the pair (l / 4, l % 4): b's are a row of four, repeated; a's element kRowOfLane[l] of
/// its row.
alignas(64) inline constexpr std::int32_t kRowOfLane[16] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                            2, 2, 2, 2, 3, 3, 3, 3};

/// Axes and centres (but for the scale and the offset) of b's boxes in a's frame: as in `Obb4`.
struct PosedBoxes {
  alignas(64) float vectors[3][4][4];

  HWY_INLINE PosedBoxes(const Obb4& boxes, const Obb4Pose& pose) {
    const hn::CappedTag<float, 16> d;
    for (std::size_t at = 0; at < 16; at += hn::Lanes(d)) {
      const auto of = [&](int k) { return hn::LoadU(d, &boxes.vectors[k][0][0] + at); };
      const auto u0 = of(0), u1 = of(1), u2 = of(2);
      for (int k = 0; k < 3; ++k)
        hn::Store(hn::MulAdd(hn::Set(d, pose.turn[2][k]), u2,
                             hn::MulAdd(hn::Set(d, pose.turn[1][k]), u1,
                                        hn::Mul(hn::Set(d, pose.turn[0][k]), u0))),
                  d, &vectors[k][0][0] + at);
    }
  }
};

/// Sixteen pairs of boxes in a's boxes' frames: what every test of them starts from.
struct BoxPairs {
  const hn::CappedTag<float, 16> d;
  using V = hn::Vec<hn::CappedTag<float, 16>>;
  static constexpr std::size_t kLanes = hn::MaxLanes(hn::CappedTag<float, 16>());
  static_assert(kLanes % 4 == 0, "rows of four: of Highway's targets SCALAR can't");

  V T[3], R[3][3], Q[3][3];  // the centre and the axes of b's box in coordinates of a's, and |R|
  V a[3], b[3];              // half extents
  V slack;                   // what all gaps have to exceed: rounding, and the pose's ball

  V set(float x) const { return hn::Set(d, x); }
  static V sum3(V x, V y, V z) { return hn::Add(hn::Add(x, y), z); }
  static V dot(V x0, V x1, V x2, V y0, V y1, V y2) {
    return hn::MulAdd(x2, y2, hn::MulAdd(x1, y1, hn::Mul(x0, y0)));
  }
  static V dotAnd(V sum, V x0, V x1, V x2, V y0, V y1, V y2) {
    return hn::MulAdd(x2, y2, hn::MulAdd(x1, y1, hn::MulAdd(x0, y0, sum)));
  }

  /// Pairs `at` and the following ones, as many as there are lanes.
  HWY_INLINE BoxPairs(const Obb4& na, const Obb4& nb, const PosedBoxes& posed, const Obb4Pose& pose,
                      std::size_t at) {
    const auto rows = hn::SetTableIndices(d, kRowOfLane + at);
    const auto first = [&](const float* four) {
      return hn::TableLookupLanes(hn::LoadDup128(d, four), rows);
    };
    const auto second = [&](const float* four) { return hn::LoadDup128(d, four); };
    const V scale = set(pose.scale);
    V p[3];
    for (int k = 0; k < 3; ++k)
      p[k] =
          hn::Sub(hn::MulAdd(scale, second(posed.vectors[k][Obb4::kCenter]), set(pose.offset[k])),
                  first(na.vectors[k][Obb4::kCenter]));
    for (int i = 0; i < 3; ++i) {
      const V u0 = first(na.vectors[0][i]), u1 = first(na.vectors[1][i]),
              u2 = first(na.vectors[2][i]);
      T[i] = dot(u0, u1, u2, p[0], p[1], p[2]);
      for (int j = 0; j < 3; ++j) {
        R[i][j] = dot(u0, u1, u2, second(posed.vectors[0][j]), second(posed.vectors[1][j]),
                      second(posed.vectors[2][j]));
        Q[i][j] = hn::Abs(R[i][j]);
      }
      a[i] = first(na.half[i]);
      b[i] = hn::Mul(scale, second(nb.half[i]));
    }
    const V sizes = sum3(sum3(hn::Abs(T[0]), hn::Abs(T[1]), hn::Abs(T[2])), sum3(a[0], a[1], a[2]),
                         sum3(b[0], b[1], b[2]));
    slack = hn::MulAdd(set(pose.relative), sizes, set(pose.ball));
  }

  /// Gaps along a's axes, b's, and the cross product of a's i-th and b's j-th (which is no unit
  /// vector).
  V faceOfA(int i) const {
    return hn::Sub(hn::Abs(T[i]), dotAnd(a[i], b[0], b[1], b[2], Q[i][0], Q[i][1], Q[i][2]));
  }
  V faceOfB(int j) const {
    return hn::Sub(hn::Abs(dot(T[0], T[1], T[2], R[0][j], R[1][j], R[2][j])),
                   dotAnd(b[j], a[0], a[1], a[2], Q[0][j], Q[1][j], Q[2][j]));
  }
  V edges(int i, int j) const {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return hn::Sub(
        hn::Abs(hn::NegMulAdd(T[i1], R[i2][j], hn::Mul(T[i2], R[i1][j]))),
        dotAnd(hn::Mul(a[i1], Q[i2][j]), a[i2], b[j1], b[j2], Q[i1][j], Q[i][j2], Q[i][j1]));
  }
  /// The square of the gap along T, from centre to centre, shrunk for rounding: of boxes far apart
  /// beside their sizes close to that of their distance. (|T|² − Σ a_i|T_i| − Σ b_j|T·R_j|)/|T|
  /// takes no axes at right angles, and the roundings that `slack` has per unit of |T|₁.
  V squareAlongCenters() const {
    const V squared = dot(T[0], T[1], T[2], T[0], T[1], T[2]);
    V apart = hn::NegMulAdd(slack, sum3(hn::Abs(T[0]), hn::Abs(T[1]), hn::Abs(T[2])), squared);
    for (int k = 0; k < 3; ++k) {
      const V along = dot(T[0], T[1], T[2], R[0][k], R[1][k], R[2][k]);
      apart = hn::NegMulAdd(a[k], hn::Abs(T[k]), hn::NegMulAdd(b[k], hn::Abs(along), apart));
    }
    // Divided first: a square of apart, which is one of lengths, would overflow from |T| = 2^32 on.
    return hn::IfThenElseZero(hn::Gt(apart, hn::Zero(d)), hn::Mul(hn::Div(apart, squared), apart));
  }
  V largestEdgeGap(V gap) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) gap = hn::Max(gap, edges(i, j));
    return gap;
  }
};

/// The bits of a mask of pairs `at` and the following ones.
template <class M>
HWY_INLINE unsigned bitsOf(const hn::CappedTag<float, 16> d, M mask, std::size_t at) {
  std::uint8_t bits[8] = {};  // StoreMaskBits may write up to eight bytes
  hn::StoreMaskBits(d, mask, bits);
  return (static_cast<unsigned>(bits[0]) | static_cast<unsigned>(bits[1]) << 8) << at;
}

/// Which of the sixteen pairs of two nodes' boxes may touch: bit 4·i + j for a's i-th and b's j-th.
/// A cleared bit is a proof that they are farther apart than `pose.ball` was asked to cover
/// (obb4.h has the derivation). `gaps` gets the largest gap along a face normal of each pair:
/// the less, the deeper they overlap.
///
/// In one order, and fused wherever the target can: all that can decide alike (SSE can't: a box
/// more or less is opened there, for the same answer). Each axis alone is a proof: a NaN on one of
/// them may be lost in a maximum, but it never separates.
HWY_INLINE unsigned overlappingBoxes(const Obb4& a, const Obb4& b, const Obb4Pose& pose,
                                     float* HWY_RESTRICT gaps) {
  const hn::CappedTag<float, 16> d;
  const PosedBoxes posed(b, pose);
  unsigned mask = 0;
  for (std::size_t at = 0; at < 16; at += BoxPairs::kLanes) {
    const BoxPairs pairs(a, b, posed, pose, at);
    auto gap = pairs.faceOfA(0);
    for (int i = 1; i < 3; ++i) gap = hn::Max(gap, pairs.faceOfA(i));
    for (int j = 0; j < 3; ++j) gap = hn::Max(gap, pairs.faceOfB(j));
    hn::Store(gap, d, gaps + at);
    auto open = hn::Not(hn::Gt(gap, pairs.slack));
    if (!hn::AllFalse(d, open)) open = hn::Not(hn::Gt(pairs.largestEdgeGap(gap), pairs.slack));
    mask |= bitsOf(d, open, at);
  }
  return mask;
}

/// Which of the sixteen pairs may be at most `limit` apart (a's unit); a cleared bit is a proof
/// that they are not. `squares` gets a proven lower bound of each pair's squared distance.
///
/// Gaps along three axes u_i at right angles bound the distance by √Σ gap_i²: for any vector d,
/// Σ(u_i·d)² ≤ (1 + 3η)|d|². For a's axes, and b's (R̂) where the map is rigid, η < 2^-17: 1 − 2^-14
/// covers that and the rounding of the sum. Of a map that is less so, `relative` took 10η·(|T|₁ +
/// Σa + Σb) ≥ 9η·|u_i·d| off each gap, and (1 − 9η)²(1 + 3η) < 1. So does the gap along the
/// centres.
///
/// `kFar`: along the line between the centres, too, which says more of boxes far apart beside their
/// sizes, and takes a fifth longer.
template <bool kFar>
HWY_INLINE unsigned nearBoxes(const Obb4& a, const Obb4& b, const Obb4Pose& pose, float limit,
                              float* HWY_RESTRICT squares) {
  const hn::CappedTag<float, 16> d;
  const PosedBoxes posed(b, pose);
  unsigned mask = 0;
  for (std::size_t at = 0; at < 16; at += BoxPairs::kLanes) {
    const BoxPairs pairs(a, b, posed, pose, at);
    const auto zero = hn::Zero(d);
    auto ofA = zero, ofB = zero;
    for (int i = 0; i < 3; ++i) {
      const auto x = hn::Max(hn::Sub(pairs.faceOfA(i), pairs.slack), zero);
      const auto y = hn::Max(hn::Sub(pairs.faceOfB(i), pairs.slack), zero);
      ofA = hn::Add(ofA, hn::Mul(x, x));
      ofB = hn::Add(ofB, hn::Mul(y, y));
    }
    auto square = hn::Max(ofA, ofB);
    if constexpr (kFar) square = hn::Max(square, pairs.squareAlongCenters());
    // An overflow or a NaN bounds nothing.
    square = hn::Mul(square, pairs.set(1 - 0x1p-14F));
    square = hn::IfThenElseZero(hn::Lt(square, pairs.set(0x1p120F)), square);
    hn::Store(square, d, squares + at);
    auto open = hn::Not(hn::Gt(square, pairs.set(limit * limit * (1 + 0x1p-20F))));
    if (!hn::AllFalse(d, open))
      open = hn::AndNot(hn::Gt(pairs.largestEdgeGap(zero),
                               hn::Add(pairs.slack, pairs.set(limit * (1 + 0x1p-16F)))),
                        open);
    mask |= bitsOf(d, open, at);
  }
  return mask;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
