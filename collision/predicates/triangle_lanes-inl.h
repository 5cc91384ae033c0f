// Pairs of triangles, one per SIMD lane. Highway's foreach_target.h includes this file once per
// SIMD target.

// clang-format off
#if defined(CORRIDOR_TRIANGLE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_TRIANGLE_LANES_INL_H_
#undef CORRIDOR_TRIANGLE_LANES_INL_H_
#else
#define CORRIDOR_TRIANGLE_LANES_INL_H_
#endif
// clang-format on

#include <cstdint>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The corners of up to sixteen triangles relative to the point `center`.
struct alignas(64) TriangleCorners {
  float x[3][3][16];  ///< [corner][coordinate][triangle]
  double center[4];   ///< the fourth number is 0
};

using LaneTag = hn::CappedTag<float, 16>;
using LaneFloat = hn::Vec<LaneTag>;
inline constexpr std::size_t kTriangleLanes = hn::MaxLanes(LaneTag());
static_assert(kTriangleLanes % 4 == 0,
              "rows of four lanes are needed; Highway's target SCALAR has too few");

/// One vector per lane.
struct LaneVec {
  LaneFloat x, y, z;
};
HWY_INLINE LaneVec sub(const LaneVec& p, const LaneVec& q) {
  return {hn::Sub(p.x, q.x), hn::Sub(p.y, q.y), hn::Sub(p.z, q.z)};
}
HWY_INLINE LaneVec cross(const LaneVec& p, const LaneVec& q) {
  return {hn::NegMulAdd(p.z, q.y, hn::Mul(p.y, q.z)), hn::NegMulAdd(p.x, q.z, hn::Mul(p.z, q.x)),
          hn::NegMulAdd(p.y, q.x, hn::Mul(p.x, q.y))};
}
HWY_INLINE LaneFloat dot(const LaneVec& p, const LaneVec& q) {
  return hn::MulAdd(p.z, q.z, hn::MulAdd(p.y, q.y, hn::Mul(p.x, q.x)));
}
HWY_INLINE LaneFloat norm1(const LaneVec& p) {
  return hn::Add(hn::Add(hn::Abs(p.x), hn::Abs(p.y)), hn::Abs(p.z));
}
HWY_INLINE LaneFloat min3(LaneFloat x, LaneFloat y, LaneFloat z) {
  return hn::Min(hn::Min(x, y), z);
}
HWY_INLINE LaneFloat max3(LaneFloat x, LaneFloat y, LaneFloat z) {
  return hn::Max(hn::Max(x, y), z);
}

/// Returns in each lane the float that the lane's index (0 to 15) selects from `sixteen`.
HWY_INLINE LaneFloat lookedUp(const float* HWY_RESTRICT sixteen,
                              hn::Vec<hn::RebindToSigned<LaneTag>> index) {
  const LaneTag d;
  if constexpr (kTriangleLanes == 16) {
    return hn::TableLookupLanes(hn::Load(d, sixteen), hn::IndicesFromVec(d, index));
  } else if constexpr (kTriangleLanes == 8) {
    const hn::RebindToSigned<LaneTag> i;
    const auto within = hn::IndicesFromVec(d, hn::And(index, hn::Set(i, 7)));
    return hn::IfThenElse(hn::RebindMask(d, hn::Gt(index, hn::Set(i, 7))),
                          hn::TableLookupLanes(hn::Load(d, sixteen + 8), within),
                          hn::TableLookupLanes(hn::Load(d, sixteen), within));
  } else {
    return hn::GatherIndex(d, sixteen, index);
  }
}

/// The pairs to test. Each pair consists of the index of a triangle of `a` and the index of a
/// triangle of `b`; both are below 16.
struct TriangleNumbers {
  const std::uint8_t *a, *b;  ///< sixteen readable indices each
};

/// The corners of the pairs `at`, `at` + 1, …, one pair per lane. s_k are the corners of a's
/// triangle, and t_k those of b's. All corners are relative to the first corner of a's triangle, so
/// s_0 is 0 and is not stored.
///
/// Rounding, u = 2^-24. Let o be the first corner of a's triangle relative to a's `center`, and ΔC
/// the difference of the two `center`s (b's minus a's). The corners of b's triangle are t = b.x +
/// (ΔC − o), in floats rounded at each step, where b.x is the stored corner. Each of b.x, o, ΔC, w
/// = ΔC − o and t is off by at most u times its own magnitude. With |ΔC| ≤ |w| + |o|, |b.x| ≤ |t| +
/// |w| and w = t_0 − b.x_0, the error is less than u(2|t| + 3|t_0| + 3|b.x_0| + 2|o|) ≤ 3u·size per
/// coordinate. (Bounds in terms of |b.x| would be worse: for small triangles far from `center`,
/// |b.x| is much larger than |t|.)
struct TrianglePairs {
  LaneVec s1, s2, t[3];
  LaneVec away;    ///< from o to the center of b: t = b.x + away
  LaneFloat size;  ///< the sum of |o|₁, |s|₁, |b.x_0|₁ and |t|₁; a maximum could lose a NaN

  HWY_INLINE TrianglePairs(const TriangleCorners& a, const TriangleCorners& b,
                           const TriangleNumbers& numbers, std::size_t at) {
    const LaneTag d;
    const hn::RebindToSigned<LaneTag> i;
    const hn::Rebind<std::uint8_t, LaneTag> bytes;
    const auto ofA = hn::PromoteTo(i, hn::LoadU(bytes, numbers.a + at)),
               ofB = hn::PromoteTo(i, hn::LoadU(bytes, numbers.b + at));
    const auto corner = [](const TriangleCorners& from, auto index, int k) {
      return LaneVec{lookedUp(from.x[k][0], index), lookedUp(from.x[k][1], index),
                     lookedUp(from.x[k][2], index)};
    };
    const LaneVec o = corner(a, ofA, 0);
    away = sub(LaneVec{hn::Set(d, static_cast<float>(b.center[0] - a.center[0])),
                       hn::Set(d, static_cast<float>(b.center[1] - a.center[1])),
                       hn::Set(d, static_cast<float>(b.center[2] - a.center[2]))},
               o);
    s1 = sub(corner(a, ofA, 1), o);
    s2 = sub(corner(a, ofA, 2), o);
    size = hn::Add(hn::Add(norm1(o), norm1(s1)), norm1(s2));
    for (int k = 0; k < 3; ++k) {
      const LaneVec p = corner(b, ofB, k);
      t[k] = {hn::Add(p.x, away.x), hn::Add(p.y, away.y), hn::Add(p.z, away.z)};
      if (k == 0) size = hn::Add(size, norm1(p));
      size = hn::Add(size, norm1(t[k]));
    }
  }
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
