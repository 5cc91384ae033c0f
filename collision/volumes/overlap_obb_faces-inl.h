// Tests one oriented box against another, along the face normals of both. Included once per SIMD
// target by foreach_target.h.

// clang-format off
#if defined(CORRIDOR_OVERLAP_OBB_FACES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_OVERLAP_OBB_FACES_INL_H_
#undef CORRIDOR_OVERLAP_OBB_FACES_INL_H_
#else
#define CORRIDOR_OVERLAP_OBB_FACES_INL_H_
#endif
// clang-format on

#include "hwy/highway.h"

#include "collision/volumes/obb4.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Returns true if a face normal of either box separates the boxes by more than `beyond` (in a's
/// unit) plus the error that `pose.absoluteMargin` covers. True is a proof by the derivation in
/// obb4.h, which holds for these lanes, too. Lane j holds b's axis j, and lane 3 its centre.
HWY_INLINE bool facesSeparate(const Obb1& a, const Obb1& b, const Obb4Pose& pose, float beyond) {
  const hn::CappedTag<float, 4> d;
  const auto set = [&](float x) { return hn::Set(d, x); };
  const auto sum = [&](auto v) { return hn::GetLane(hn::SumOfLanes(d, v)); };
  alignas(16) static constexpr float kAxes[4] = {1, 1, 1, 0};
  const auto axes = hn::Ne(hn::Load(d, kAxes), hn::Zero(d));
  const auto ofCenter = [&](auto v) { return hn::IfThenZeroElse(axes, v); };
  const auto scales = hn::IfThenElse(axes, set(1), set(pose.scale));
  const auto u0 = hn::Load(d, b.vectors[0]), u1 = hn::Load(d, b.vectors[1]),
             u2 = hn::Load(d, b.vectors[2]);
  const auto posed = [&](int k) {
    const auto turned =
        hn::MulAdd(set(pose.turn[2][k]), u2,
                   hn::MulAdd(set(pose.turn[1][k]), u1, hn::Mul(set(pose.turn[0][k]), u0)));
    return hn::Sub(hn::MulAdd(scales, turned, ofCenter(set(pose.offset[k]))),
                   ofCenter(hn::Load(d, a.vectors[k])));
  };
  const auto p0 = posed(0), p1 = posed(1), p2 = posed(2);
  const auto halfB = hn::Mul(set(pose.scale), hn::Load(d, b.half));
  // Row i has the products of a's axis i with b's axes; lane 3 is the distance of the centres along
  // a's axis i.
  const auto row = [&](int i) {
    return hn::MulAdd(set(a.vectors[2][i]), p2,
                      hn::MulAdd(set(a.vectors[1][i]), p1, hn::Mul(set(a.vectors[0][i]), p0)));
  };
  const auto r0 = row(0), r1 = row(1), r2 = row(2);
  const auto q0 = hn::Abs(r0), q1 = hn::Abs(r1), q2 = hn::Abs(r2);
  const float* h = a.half;
  // Σ_j b_j |R_ij| − |T_i|
  const auto reach = hn::IfThenElse(axes, halfB, set(-1));
  const float gapA0 = -(sum(hn::Mul(q0, reach)) + h[0]), gapA1 = -(sum(hn::Mul(q1, reach)) + h[1]),
              gapA2 = -(sum(hn::Mul(q2, reach)) + h[2]);
  const auto along =
      hn::Abs(hn::MulAdd(hn::Broadcast<3>(r2), r2,
                         hn::MulAdd(hn::Broadcast<3>(r1), r1, hn::Mul(hn::Broadcast<3>(r0), r0))));
  const auto gapsB = hn::Sub(
      along,
      hn::MulAdd(set(h[2]), q2, hn::MulAdd(set(h[1]), q1, hn::MulAdd(set(h[0]), q0, halfB))));
  const auto ofT = ofCenter(hn::Add(hn::Add(q0, q1), q2));
  const float slack =
      pose.relative * (sum(hn::Add(ofT, hn::IfThenElseZero(axes, halfB))) + (h[0] + h[1] + h[2])) +
      pose.absoluteMargin + beyond;
  return gapA0 > slack || gapA1 > slack || gapA2 > slack ||
         !hn::AllFalse(d, hn::And(axes, hn::Gt(gapsB, set(slack))));
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
