// Four oriented boxes against four that move, for every SIMD target: included once per target by
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

/// Sixteen pairs of boxes of which b's move: how far these go along the axes that are tested.
struct MovingBoxPairs : BoxPairs {
  V v[3], w[3], wB[3];  // in coordinates of a's box: V, W; and W·R_j
  V bend, curvature, cap;
  V rounding;  // the slack but for what the motion itself may be off

  HWY_INLINE MovingBoxPairs(const Obb4& na, const Obb4& nb, const PosedBoxes& posed,
                            const Obb4Pose& pose, const Obb4Travel& travel, std::size_t at)
      : BoxPairs(na, nb, posed, pose, at) {
    const auto rows = hn::SetTableIndices(d, kRowOfLane + at);
    const auto second = [&](const float* four) { return hn::LoadDup128(d, four); };
    for (int i = 0; i < 3; ++i) {
      const auto axis = [&](int k) {
        return hn::TableLookupLanes(hn::LoadDup128(d, na.vectors[k][i]), rows);
      };
      const V u0 = axis(0), u1 = axis(1), u2 = axis(2);
      v[i] = dot(u0, u1, u2, second(travel.linear[0]), second(travel.linear[1]),
                 second(travel.linear[2]));
      w[i] =
          dot(u0, u1, u2, set(travel.angular[0]), set(travel.angular[1]), set(travel.angular[2]));
    }
    for (int j = 0; j < 3; ++j) wB[j] = dot(w[0], w[1], w[2], R[0][j], R[1][j], R[2][j]);
    bend = second(travel.bend);
    curvature = second(travel.curvature);
    cap = second(travel.cap);
    const V pad = second(travel.pad);
    const V turn = sum3(hn::Abs(w[0]), hn::Abs(w[1]), hn::Abs(w[2]));
    const V size = hn::Add(sum3(b[0], b[1], b[2]), bend);
    const V terms = hn::Add(sum3(hn::Abs(v[0]), hn::Abs(v[1]), hn::Abs(v[2])),
                            hn::MulAdd(hn::Add(turn, turn), size, hn::Add(curvature, pad)));
    rounding = hn::MulAdd(set(pose.relative), terms, slack);
    slack = hn::Add(pad, rounding);
  }

  /// At least √(x² + y²), 9 % above it at most.
  V length(V x, V y) const {
    x = hn::Abs(x);
    y = hn::Abs(y);
    return hn::MulAdd(set(0.41422F), hn::Min(x, y), hn::Max(x, y));
  }
  /// The cap and the directional bound: each is a proof, so that a NaN of either may be lost.
  V least(V directional) const { return hn::Min(directional, cap); }

  V alongFaceA(int i) const {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    V sum = hn::Add(hn::Abs(v[i]), hn::MulAdd(bend, length(w[i1], w[i2]), curvature));
    for (int k = 0; k < 3; ++k) {
      const V spin = hn::NegMulAdd(R[i1][k], w[i2], hn::Mul(R[i2][k], w[i1]));
      sum = hn::MulAdd(b[k], hn::Abs(spin), sum);
    }
    return least(sum);
  }
  V alongFaceB(int j) const {
    const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const V linear = hn::Abs(dot(v[0], v[1], v[2], R[0][j], R[1][j], R[2][j]));
    V sum = hn::Add(linear, hn::MulAdd(bend, length(wB[j1], wB[j2]), curvature));
    sum = hn::MulAdd(b[j1], hn::Abs(wB[j2]), hn::MulAdd(b[j2], hn::Abs(wB[j1]), sum));
    return least(sum);
  }
  V alongEdges(int i, int j) const {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    const V linear = hn::Abs(hn::NegMulAdd(v[i1], R[i2][j], hn::Mul(v[i2], R[i1][j])));
    const V turn = hn::Abs(wB[j]);
    // |n × W| = |R_j W_i − e_i (W·R_j)|
    V sum = hn::Add(linear, hn::MulAdd(bend, hn::Add(hn::Abs(w[i]), turn), curvature));
    sum = hn::MulAdd(b[j], hn::Abs(hn::NegMulAdd(R[i][j], wB[j], w[i])), sum);
    sum = hn::MulAdd(turn, hn::MulAdd(b[j1], Q[i][j1], hn::Mul(b[j2], Q[i][j2])), sum);
    return least(sum);
  }
};

/// What a window of time says of sixteen pairs.
struct MovingBoxes {
  unsigned open = 0;    ///< not proved apart: a cleared bit is a proof for all of the window
  unsigned coarse = 0;  ///< b's box goes farther in the window than both boxes are large
};

/// When a shorter window is worth more than smaller boxes: measured, soundness needs neither.
constexpr float kTravelOfSize = 1, kRemainderOfSize = 32;

/// `keys` gets the largest gap along a face normal of each pair, less what b travels along it.
/// (obb4.h has the derivation.)
/// @param clearances where not null, gets how much farther apart than the pad each pair that is
/// told apart is proved to be all along the window, in a's unit (axes are no longer than 1 + 2^-20,
/// and the difference rounds by 2^-24 of itself).
HWY_INLINE MovingBoxes movingBoxes(const Obb4& a, const Obb4& b, const Obb4Pose& pose,
                                   const Obb4Travel& travel, float* HWY_RESTRICT keys,
                                   float* HWY_RESTRICT clearances = nullptr) {
  const hn::CappedTag<float, 16> d;
  const PosedBoxes posed(b, pose);
  MovingBoxes found;
  for (std::size_t at = 0; at < 16; at += BoxPairs::kLanes) {
    const MovingBoxPairs pairs(a, b, posed, pose, travel, at);
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
    const auto remainder = hn::MulAdd(pairs.bend, turn, pairs.curvature);
    // Boxes that rounding makes large are not told apart by shorter windows.
    const auto size = hn::Max(hn::Max(pairs.a[0], pairs.b[0]), pairs.rounding);
    const auto coarse = hn::Or(hn::Gt(hn::Mul(pairs.set(kRemainderOfSize), remainder), size),
                               hn::Gt(pairs.cap, hn::Mul(pairs.set(kTravelOfSize), size)));
    found.coarse |= bitsOf(d, coarse, at);
  }
  found.coarse &= found.open;
  return found;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
