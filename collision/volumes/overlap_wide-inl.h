// Four oriented boxes against four, for every SIMD target: included once per target by foreach_target.h.

// clang-format off
#if defined(CORRIDOR_OVERLAP_WIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_OVERLAP_WIDE_INL_H_
#undef CORRIDOR_OVERLAP_WIDE_INL_H_
#else
#define CORRIDOR_OVERLAP_WIDE_INL_H_
#endif
// clang-format on

#include "hwy/highway.h"

#include "collision/core/lanes.h"
#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/volumes/wide_pose.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Which of the sixteen pairs of two nodes' boxes may touch: bit 4·i + j for a's i-th and b's j-th. A
/// cleared bit is a proof that they are farther apart than `pose.ball` was asked to cover
/// (wide_pose.h has the derivation). `gaps` gets the largest gap along a face normal of each
/// pair: the less, the deeper they overlap. (A cross axis is no unit vector, and of nearly parallel
/// edges it is none at all.)
///
/// Separate multiplications and additions in one order, so that all targets decide alike. Each axis
/// alone is a proof: a NaN on one of them may be lost in a maximum, but it never separates.
HWY_INLINE unsigned overlappingBoxes(const WideObbTree::Node& a, const WideObbTree::Node& b,
                                     const FloatPose& pose, float* HWY_RESTRICT gaps) {
  const hn::CappedTag<float, 16> d;
  using V = hn::Vec<decltype(d)>;
  constexpr std::size_t kLanes = hn::MaxLanes(hn::CappedTag<float, 16>());
  unsigned mask = 0;
  const auto set = [&](float x) { return hn::Set(d, x); };
  const auto sum3 = [](V x, V y, V z) { return hn::Add(hn::Add(x, y), z); };
  const auto dot = [&](V x0, V x1, V x2, V y0, V y1, V y2) {
    return sum3(hn::Mul(x0, y0), hn::Mul(x1, y1), hn::Mul(x2, y2));
  };
  for (std::size_t at = 0; at < 16; at += kLanes) {
    const auto rows = hn::SetTableIndices(d, kRowOfLane + at);
    const auto first = [&](const float* four) {
      return hn::TableLookupLanes(hn::LoadDup128(d, four), rows);
    };
    const auto second = [&](const float* four) { return hn::LoadDup128(d, four); };
    // b's box in a's frame: centre relative to a's, axes.
    const V c0 = second(b.center[0]), c1 = second(b.center[1]), c2 = second(b.center[2]);
    V p[3];
    for (int k = 0; k < 3; ++k)
      p[k] = hn::Sub(hn::Add(dot(set(pose.scaled[k][0]), set(pose.scaled[k][1]), set(pose.scaled[k][2]),
                                 c0, c1, c2),
                             set(pose.offset[k])),
                     first(a.center[k]));
    V v[3][3];
    for (int j = 0; j < 3; ++j) {
      const V u0 = second(b.axes[j][0]), u1 = second(b.axes[j][1]), u2 = second(b.axes[j][2]);
      for (int k = 0; k < 3; ++k)
        v[j][k] = dot(set(pose.turn[k][0]), set(pose.turn[k][1]), set(pose.turn[k][2]), u0, u1, u2);
    }
    V T[3], R[3][3], Q[3][3];
    for (int i = 0; i < 3; ++i) {
      const V u0 = first(a.axes[i][0]), u1 = first(a.axes[i][1]), u2 = first(a.axes[i][2]);
      T[i] = dot(u0, u1, u2, p[0], p[1], p[2]);
      for (int j = 0; j < 3; ++j) {
        R[i][j] = dot(u0, u1, u2, v[j][0], v[j][1], v[j][2]);
        Q[i][j] = hn::Abs(R[i][j]);
      }
    }
    const V ha[3] = {first(a.half[0]), first(a.half[1]), first(a.half[2])};
    const V scale = set(pose.scale);
    const V hb[3] = {hn::Mul(scale, second(b.half[0])), hn::Mul(scale, second(b.half[1])),
                     hn::Mul(scale, second(b.half[2]))};
    const V t[3] = {hn::Abs(T[0]), hn::Abs(T[1]), hn::Abs(T[2])};
    const V sizes = sum3(sum3(t[0], t[1], t[2]), sum3(ha[0], ha[1], ha[2]), sum3(hb[0], hb[1], hb[2]));
    const V slack = hn::Add(hn::Mul(set(pose.relative), sizes), set(pose.ball));
    // The faces of a's box.
    V gap = hn::Undefined(d);
    for (int i = 0; i < 3; ++i) {
      const V reach = hn::Add(dot(hb[0], hb[1], hb[2], Q[i][0], Q[i][1], Q[i][2]), ha[i]);
      const V g = hn::Sub(t[i], reach);
      gap = i == 0 ? g : hn::Max(gap, g);
    }
    // Those of b's box.
    for (int j = 0; j < 3; ++j) {
      const V along = hn::Abs(dot(T[0], T[1], T[2], R[0][j], R[1][j], R[2][j]));
      const V reach = hn::Add(dot(ha[0], ha[1], ha[2], Q[0][j], Q[1][j], Q[2][j]), hb[j]);
      gap = hn::Max(gap, hn::Sub(along, reach));
    }
    hn::Store(gap, d, gaps + at);
    auto open = hn::Not(hn::Gt(gap, slack));
    if (!hn::AllFalse(d, open)) {
      for (int i = 0; i < 3; ++i) {
        const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
        for (int j = 0; j < 3; ++j) {
          const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
          const V along = hn::Abs(hn::Sub(hn::Mul(T[i2], R[i1][j]), hn::Mul(T[i1], R[i2][j])));
          const V reach = hn::Add(hn::Add(hn::Mul(ha[i1], Q[i2][j]), hn::Mul(ha[i2], Q[i1][j])),
                                  hn::Add(hn::Mul(hb[j1], Q[i][j2]), hn::Mul(hb[j2], Q[i][j1])));
          gap = hn::Max(gap, hn::Sub(along, reach));
        }
      }
      open = hn::Not(hn::Gt(gap, slack));
    }
    std::uint8_t bits[8] = {};  // StoreMaskBits may write up to eight bytes
    hn::StoreMaskBits(d, open, bits);
    mask |= (static_cast<unsigned>(bits[0]) | static_cast<unsigned>(bits[1]) << 8) << at;
  }
  return mask;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
