// Tests four oriented boxes against four others. Included once per SIMD target by foreach_target.h.

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

/// Lane l is the pair of boxes (l / 4, l % 4). A row of four values, one for each of b's boxes, is
/// repeated in all groups of four lanes. From a row of a's values, lane l takes element
/// kRowOfLane[l].
alignas(64) inline constexpr std::int32_t kRowOfLane[16] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                            2, 2, 2, 2, 3, 3, 3, 3};

/// Axes and centres of b's boxes, rotated into a's frame, laid out as in `Obb4`. Scale and offset
/// are not yet applied.
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

/// Up to sixteen pairs of boxes, one per lane, each in the frame of a's box: the input of every
/// test.
struct BoxPairs {
  const hn::CappedTag<float, 16> d;
  using V = hn::Vec<hn::CappedTag<float, 16>>;
  static constexpr std::size_t kLanes = hn::MaxLanes(hn::CappedTag<float, 16>());
  static_assert(kLanes % 4 == 0,
                "rows of four lanes are needed; Highway's target SCALAR has too few");

  // Centre T and axes R of b's box in coordinates of a's box, and Q = |R|.
  V T[3], R[3][3], Q[3][3];
  V a[3], b[3];  // half extents
  V slack;       // a gap must exceed this to separate: rounding, and the pose's `absoluteMargin`

  V set(float x) const { return hn::Set(d, x); }
  static V sum3(V x, V y, V z) { return hn::Add(hn::Add(x, y), z); }
  static V dot(V x0, V x1, V x2, V y0, V y1, V y2) {
    return hn::MulAdd(x2, y2, hn::MulAdd(x1, y1, hn::Mul(x0, y0)));
  }
  static V dotAnd(V sum, V x0, V x1, V x2, V y0, V y1, V y2) {
    return hn::MulAdd(x2, y2, hn::MulAdd(x1, y1, hn::MulAdd(x0, y0, sum)));
  }

  /// Loads pair `at` and the following ones, as many as there are lanes.
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
    slack = hn::MulAdd(set(pose.relative), sizes, set(pose.absoluteMargin));
  }

  /// The next three functions return gaps, in a's unit, before `slack` is subtracted: along axis i
  /// of a, along axis j of b, and along the cross product of both axes. The cross product is not a
  /// unit vector.
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
  /// Returns a lower bound of the squared gap along T, the line between the centres. For boxes that
  /// are far apart relative to their sizes, this bound is close to the squared distance. The gap
  /// (|T|² − Σ a_i|T_i| − Σ b_j|T·R_j|)/|T| needs no orthogonal axes, and its rounding is below
  /// `slack` per unit of |T|₁.
  V squareAlongCenters() const {
    const V squared = dot(T[0], T[1], T[2], T[0], T[1], T[2]);
    V apart = hn::NegMulAdd(slack, sum3(hn::Abs(T[0]), hn::Abs(T[1]), hn::Abs(T[2])), squared);
    for (int k = 0; k < 3; ++k) {
      const V along = dot(T[0], T[1], T[2], R[0][k], R[1][k], R[2][k]);
      apart = hn::NegMulAdd(a[k], hn::Abs(T[k]), hn::NegMulAdd(b[k], hn::Abs(along), apart));
    }
    // The division comes first: `apart` is a squared length, and its square would overflow for |T|
    // ≥ 2^32.
    return hn::IfThenElseZero(hn::Gt(apart, hn::Zero(d)), hn::Mul(hn::Div(apart, squared), apart));
  }
  V largestEdgeGap(V gap) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) gap = hn::Max(gap, edges(i, j));
    return gap;
  }
};

/// Returns the bits of a mask, shifted so that the first bit is that of pair `at`.
template <class M>
HWY_INLINE unsigned bitsOf(const hn::CappedTag<float, 16> d, M mask, std::size_t at) {
  std::uint8_t bits[8] = {};  // StoreMaskBits may write up to eight bytes
  hn::StoreMaskBits(d, mask, bits);
  return (static_cast<unsigned>(bits[0]) | static_cast<unsigned>(bits[1]) << 8) << at;
}

/// Returns which of the sixteen pairs of two nodes' boxes may touch: bit 4·i + j for box i of a and
/// box j of b. A cleared bit proves that the boxes are farther apart than the error that
/// `pose.absoluteMargin` covers (obb4.h has the derivation). `gaps` receives for each pair the
/// largest gap along a face normal; a smaller gap means a deeper overlap.
///
/// Operations have a fixed order, and are fused on every target that supports it, so that these
/// targets give the same bits. SSE has no fused operations. There, the test may report one pair
/// more or less as overlapping, but the query's answer is the same. Each axis alone is a proof. A
/// maximum may drop the NaN of one axis, but a NaN never separates.
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

/// Returns which of the sixteen pairs may be at most `limit` apart (in a's unit). A cleared bit
/// proves that the boxes are farther apart. `squares` receives for each pair a proved lower bound
/// of the squared distance, in the square of a's unit.
///
/// The gaps along three orthogonal axes u_i give the lower bound √Σ gap_i² of the distance: for any
/// vector d, Σ(u_i·d)² ≤ (1 + 3η)|d|². For a's axes, and for b's (R̂) if the map is rigid, η <
/// 2^-17. The factor 1 − 2^-14 covers that and the rounding of the sum. For a less rigid map,
/// `relative` has reduced each gap by 10η·(|T|₁ + Σa + Σb) ≥ 9η·|u_i·d|, and (1 − 9η)²(1 + 3η) < 1.
/// The same holds for the gap along the line between the centres.
///
/// `kFar` adds the line between the centres as an axis. This axis is the best one for boxes that
/// are far apart relative to their sizes. With this axis, the test takes a fifth longer.
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
    // A bound that overflows or is NaN becomes 0.
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
