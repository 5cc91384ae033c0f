// Tests four oriented boxes against four moving oriented boxes. Included once per SIMD target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_OVERLAP_OBB4_MOVING_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_OVERLAP_OBB4_MOVING_INL_H_
#undef CORRIDOR_OVERLAP_OBB4_MOVING_INL_H_
#else
#define CORRIDOR_OVERLAP_OBB4_MOVING_INL_H_
#endif
// clang-format on

#include "hwy/highway.h"

#include "collision/volumes/overlap_obb4_obb4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// Pairs of boxes, one pair per lane; the boxes of b move. Computes the motion bound of b's box
/// along each tested axis.
struct MovingBoxPairs : BoxPairs {
  V v[3], w[3], wB[3];  // obb4.h: V and W in coordinates of a's box, and W·R_j
  V secondOrderAcross, secondOrder, isotropic;
  V rounding;  // the slack without `pad`

  HWY_INLINE MovingBoxPairs(const Obb4& na, const Obb4& nb, const PosedBoxes& posed,
                            const Obb4Pose& pose, const Obb4MotionBound& bound, std::size_t at)
      : BoxPairs(na, nb, posed, pose, at) {
    const auto rows = hn::SetTableIndices(d, kRowOfLane + at);
    const auto second = [&](const float* four) { return hn::LoadDup128(d, four); };
    for (int i = 0; i < 3; ++i) {
      const auto axis = [&](int k) {
        return hn::TableLookupLanes(hn::LoadDup128(d, na.vectors[k][i]), rows);
      };
      const V u0 = axis(0), u1 = axis(1), u2 = axis(2);
      v[i] = dot(u0, u1, u2, second(bound.linear[0]), second(bound.linear[1]),
                 second(bound.linear[2]));
      w[i] = dot(u0, u1, u2, set(bound.angular[0]), set(bound.angular[1]), set(bound.angular[2]));
    }
    for (int j = 0; j < 3; ++j) wB[j] = dot(w[0], w[1], w[2], R[0][j], R[1][j], R[2][j]);
    secondOrderAcross = second(bound.secondOrderAcross);
    secondOrder = second(bound.secondOrder);
    isotropic = second(bound.isotropic);
    const V pad = second(bound.pad);
    const V turn = sum3(hn::Abs(w[0]), hn::Abs(w[1]), hn::Abs(w[2]));
    const V size = hn::Add(sum3(b[0], b[1], b[2]), secondOrderAcross);
    const V terms = hn::Add(sum3(hn::Abs(v[0]), hn::Abs(v[1]), hn::Abs(v[2])),
                            hn::MulAdd(hn::Add(turn, turn), size, hn::Add(secondOrder, pad)));
    rounding = hn::MulAdd(set(pose.relative), terms, slack);
    slack = hn::Add(pad, rounding);
  }

  /// Returns an upper bound of √(x² + y²), at most 9 % above it.
  V length(V x, V y) const {
    x = hn::Abs(x);
    y = hn::Abs(y);
    return hn::MulAdd(set(0.41422F), hn::Min(x, y), hn::Max(x, y));
  }
  /// Returns the smaller of the isotropic and the directional bound. Each bound alone is a proof,
  /// so it does no harm if the minimum drops a NaN of one bound.
  V least(V directional) const { return hn::Min(directional, isotropic); }

  V alongFaceA(int i) const {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    V sum =
        hn::Add(hn::Abs(v[i]), hn::MulAdd(secondOrderAcross, length(w[i1], w[i2]), secondOrder));
    for (int k = 0; k < 3; ++k) {
      const V spin = hn::NegMulAdd(R[i1][k], w[i2], hn::Mul(R[i2][k], w[i1]));
      sum = hn::MulAdd(b[k], hn::Abs(spin), sum);
    }
    return least(sum);
  }
  V alongFaceB(int j) const {
    const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const V linear = hn::Abs(dot(v[0], v[1], v[2], R[0][j], R[1][j], R[2][j]));
    V sum = hn::Add(linear, hn::MulAdd(secondOrderAcross, length(wB[j1], wB[j2]), secondOrder));
    sum = hn::MulAdd(b[j1], hn::Abs(wB[j2]), hn::MulAdd(b[j2], hn::Abs(wB[j1]), sum));
    return least(sum);
  }
  V alongEdges(int i, int j) const {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const V linear = hn::Abs(hn::NegMulAdd(v[i1], R[i2][j], hn::Mul(v[i2], R[i1][j])));
    const V turn = hn::Abs(wB[j]);
    // |n × W| = |R_j W_i − e_i (W·R_j)|
    V sum =
        hn::Add(linear, hn::MulAdd(secondOrderAcross, hn::Add(hn::Abs(w[i]), turn), secondOrder));
    sum = hn::MulAdd(b[j], hn::Abs(hn::NegMulAdd(R[i][j], wB[j], w[i])), sum);
    sum = hn::MulAdd(turn, hn::MulAdd(b[j1], Q[i][j1], hn::Mul(b[j2], Q[i][j2])), sum);
    return least(sum);
  }
};

/// The answer for sixteen pairs over a time interval.
struct MovingBoxes {
  /// Pairs not proved separated. A cleared bit proves separation over the whole interval.
  unsigned open = 0;
  /// Open pairs for which b's box moves far in the interval, relative to the sizes of both boxes.
  unsigned coarse = 0;
};

/// Thresholds of motion bounds, relative to the size of the boxes. Above them, halving the interval
/// helps more than descending to smaller boxes. `kTravelOfSize` is the threshold of the isotropic
/// bound. The threshold of the remainder beyond first order is 1/`kRemainderOfSize`. Both values
/// were found by measurement; no proof depends on them.
constexpr float kTravelOfSize = 1, kRemainderOfSize = 32;

/// Tests the sixteen pairs over a time interval (obb4.h has the derivation). For a face
/// normal, let g be the gap along the normal minus the motion bound of b along it. `keys` receives
/// the largest g of each pair, in a's unit.
/// @param clearances  if not null, receives for each separated pair a lower bound of (distance
/// minus `pad`), valid over the whole interval, in a's unit. The factor 1 − 2^-18 covers axes of
/// length up to 1 + 2^-20, and the relative rounding error 2^-24 of the difference.
HWY_INLINE MovingBoxes movingBoxes(const Obb4& a, const Obb4& b, const Obb4Pose& pose,
                                   const Obb4MotionBound& bound, float* HWY_RESTRICT keys,
                                   float* HWY_RESTRICT clearances = nullptr) {
  const hn::CappedTag<float, 16> d;
  const PosedBoxes posed(b, pose);
  MovingBoxes found;
  for (std::size_t at = 0; at < 16; at += BoxPairs::kLanes) {
    const MovingBoxPairs pairs(a, b, posed, pose, bound, at);
    auto gap = hn::Sub(pairs.faceOfA(0), pairs.alongFaceA(0));
    for (int i = 1; i < 3; ++i) gap = hn::Max(gap, hn::Sub(pairs.faceOfA(i), pairs.alongFaceA(i)));
    for (int j = 0; j < 3; ++j) gap = hn::Max(gap, hn::Sub(pairs.faceOfB(j), pairs.alongFaceB(j)));
    hn::Store(gap, d, keys + at);
    auto open = hn::Not(hn::Gt(gap, pairs.slack));
    if (!hn::AllFalse(d, open)) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          gap = hn::Max(gap, hn::Sub(pairs.edges(i, j), pairs.alongEdges(i, j)));
      open = hn::Not(hn::Gt(gap, pairs.slack));
    }
    found.open |= bitsOf(d, open, at);
    if (clearances)
      hn::Store(hn::Mul(pairs.set(1 - 0x1p-18F), hn::Sub(gap, pairs.slack)), d, clearances + at);
    const auto turn = BoxPairs::sum3(hn::Abs(pairs.w[0]), hn::Abs(pairs.w[1]), hn::Abs(pairs.w[2]));
    const auto remainder = hn::MulAdd(pairs.secondOrderAcross, turn, pairs.secondOrder);
    // A shorter interval does not separate boxes for which rounding exceeds their sizes.
    const auto size = hn::Max(hn::Max(pairs.a[0], pairs.b[0]), pairs.rounding);
    const auto coarse = hn::Or(hn::Gt(hn::Mul(pairs.set(kRemainderOfSize), remainder), size),
                               hn::Gt(pairs.isotropic, hn::Mul(pairs.set(kTravelOfSize), size)));
    found.coarse |= bitsOf(d, coarse, at);
  }
  found.coarse &= found.open;
  return found;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
