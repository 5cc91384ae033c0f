// Tests of pairs of triangles of which the second one moves, for every SIMD target:
// foreach_target.h includes this file once per target.

// clang-format off
#if defined(CORRIDOR_MOVING_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_MOVING_TRIANGLES_INL_H_
#undef CORRIDOR_MOVING_TRIANGLES_INL_H_
#else
#define CORRIDOR_MOVING_TRIANGLES_INL_H_
#endif
// clang-format on

#include <cmath>

#include "hwy/highway.h"

#include "collision/motion/motion_bound4-inl.h"
#include "collision/queries/triangle_distances-inl.h"
#include "collision/volumes/overlap_obb4_obb4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// The result for sixteen pairs, one bit each.
struct MovingPairs {
  unsigned apart = 0;  ///< proved farther apart than `pad` throughout the interval
  /// Farther apart than `pad` at the middle, but the motion clearly exceeds the gap. Double
  /// precision would not help; shorter intervals may.
  unsigned later = 0;
};

/// Tests sixteen pairs of triangles in a time interval, in float. Let t_k be the member `t[k]` of
/// `TrianglePairs`, and n the direction of the closest points at the middle (any direction is
/// valid). Along n, corner k of b is at n·t_k at the middle. Until the time s of the interval, |s|
/// ≤ 1, it moves by s·h_k and a remainder, where h_k = n·linear + (n × angular)·p_k. Here p_k is
/// the corner relative to the point whose first-order displacement is `linear`. In any direction,
/// corner k moves by at most `isotropic`.
///
/// Rounding, with u = 2^-24, ω = `angular`, and D and `away` the members `size` and `away` of
/// `TrianglePairs`. The error of n·t_k is `off`, as in `triangleDistances`. p_k = t_k − away is off
/// by 4u·D per coordinate, and its magnitude is below 2D. n × angular is off by 2u|n||ω|. Therefore
/// h_k is off by less than u|n|(6|linear|₁ + 32|ω|₁D). This includes the rounding of `linear` and
/// `angular` themselves (u of each).
///
/// @param clearances if not null, receives a proved clearance for each separated pair: its distance
/// beyond `pad` throughout the interval, in a's unit.
HWY_INLINE MovingPairs movingTriangles(const TriangleCorners& a, const TriangleCorners& b,
                                       const TriangleNumbers& numbers, float error,
                                       const LeafMotionBound& bound,
                                       float* HWY_RESTRICT clearances = nullptr) {
  const LaneTag d;
  using V = LaneFloat;
  const auto set = [&](float x) { return hn::Set(d, x); };
  const V zero = hn::Zero(d);
  const LaneVec linear{set(bound.linear[0]), set(bound.linear[1]), set(bound.linear[2])},
      angular{set(bound.angular[0]), set(bound.angular[1]), set(bound.angular[2])};
  const V pad = set(bound.pad);
  // The error of the corners at the middle, and the resulting error of their motion.
  const V reach = hn::Mul(hn::Add(set(1 + 0x1p-20F), norm1(angular)), set(error));
  MovingPairs found;
  for (std::size_t at = 0; at < 16; at += kTriangleLanes) {
    const TrianglePairs pairs(a, b, numbers, at);
    const auto [n, square] = closestLanes(pairs);
    const V length = hn::Sqrt(square);
    const V highest = max3(zero, dot(n, pairs.s1), dot(n, pairs.s2));
    const V along = dot(n, linear);
    const LaneVec spin = cross(n, angular);
    V still[3], moving[3];
    for (int k = 0; k < 3; ++k) {
      still[k] = dot(n, pairs.t[k]);
      moving[k] =
          hn::Sub(still[k], hn::Abs(hn::Add(along, dot(spin, sub(pairs.t[k], pairs.away)))));
    }
    // Gaps along a unit vector: the quotient and the root round by less than 4u.
    const V per = hn::Div(set(1), length);
    const auto gapOf = [&](const V(&x)[3]) {
      return hn::Mul(hn::Sub(min3(x[0], x[1], x[2]), highest), per);
    };
    const V middle = gapOf(still);
    const V D = pairs.size;
    const V off = hn::MulAdd(set(48 * 0x1p-24F), D, reach);
    const V more = hn::Mul(set(32 * 0x1p-24F),
                           hn::MulAdd(norm1(angular), D, hn::Add(norm1(linear), hn::Abs(middle))));
    const V lost = hn::Add(off, more);
    const V isotropic = hn::Sub(middle, set(bound.isotropic)),
            directional = hn::Sub(gapOf(moving), set(bound.remainder));
    const V gap = hn::Sub(hn::Max(isotropic, directional), pad);
    const auto known = hn::And(hn::Lt(D, set(0x1p50F)), hn::Gt(length, set(0x1p-50F)));
    const auto apart = hn::And(known, hn::Gt(gap, lost));
    const auto later = hn::And(hn::Gt(hn::Sub(middle, pad), lost), hn::Lt(gap, hn::Neg(lost)));
    if (clearances) hn::Store(hn::Mul(set(1 - 0x1p-18F), hn::Sub(gap, lost)), d, clearances + at);
    found.apart |= bitsOf(d, apart, at);
    found.later |= bitsOf(d, hn::And(known, later), at);
  }
  return found;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
