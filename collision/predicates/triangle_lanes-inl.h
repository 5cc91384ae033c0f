// Four triangles and four others as SIMD lanes, for every SIMD target: included once per target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_TRIANGLE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_TRIANGLE_LANES_INL_H_
#undef CORRIDOR_TRIANGLE_LANES_INL_H_
#else
#define CORRIDOR_TRIANGLE_LANES_INL_H_
#endif
// clang-format on

#include "hwy/highway.h"

#include "collision/core/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Corners of four triangles, relative to a point: [corner][coordinate][triangle].
struct alignas(64) LeafCorners {
  float x[3][3][4];
  double center[3];
};

using LaneTag = hn::CappedTag<float, 16>;
using LaneFloat = hn::Vec<LaneTag>;
inline constexpr std::size_t kTriangleLanes = hn::MaxLanes(LaneTag());
static_assert(kTriangleLanes % 4 == 0, "rows of four: of Highway's targets SCALAR can't");

/// A vector a lane.
struct LaneVec {
  LaneFloat x, y, z;
};
HWY_INLINE LaneVec sub(const LaneVec& p, const LaneVec& q) {
  return {hn::Sub(p.x, q.x), hn::Sub(p.y, q.y), hn::Sub(p.z, q.z)};
}
HWY_INLINE LaneVec cross(const LaneVec& p, const LaneVec& q) {
  return {hn::Sub(hn::Mul(p.y, q.z), hn::Mul(p.z, q.y)),
          hn::Sub(hn::Mul(p.z, q.x), hn::Mul(p.x, q.z)),
          hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x))};
}
HWY_INLINE LaneFloat dot(const LaneVec& p, const LaneVec& q) {
  return hn::Add(hn::Add(hn::Mul(p.x, q.x), hn::Mul(p.y, q.y)), hn::Mul(p.z, q.z));
}
HWY_INLINE LaneFloat sum(const LaneVec& p) {
  return hn::Add(hn::Add(hn::Abs(p.x), hn::Abs(p.y)), hn::Abs(p.z));
}
HWY_INLINE LaneFloat min3(LaneFloat x, LaneFloat y, LaneFloat z) {
  return hn::Min(hn::Min(x, y), z);
}
HWY_INLINE LaneFloat max3(LaneFloat x, LaneFloat y, LaneFloat z) {
  return hn::Max(hn::Max(x, y), z);
}

/// The pairs of lanes at, at + 1, …: corners of both relative to the first one of a's, which is s_0
/// = 0.
///
/// Rounding, u = 2^-24. With o that corner, b's are t = b.x + (ΔC − o), ΔC the difference of the
/// leaves' points, in floats rounded at each step, so off by u(3|b.x| + 3|t| + 2|o|) < 3u·size a
/// coordinate (b.x alone may be far larger than t: a leaf of small triangles far apart).
struct TrianglePairs {
  LaneVec s1, s2, t[3];
  LaneFloat size;  ///< the sum of all those sizes, in |.|₁; not a maximum, which could lose a NaN

  HWY_INLINE TrianglePairs(const LeafCorners& a, const LeafCorners& b, std::size_t at) {
    const LaneTag d;
    const auto rows = hn::SetTableIndices(d, kRowOfLane + at);
    const auto corner = [&](int k) {
      return LaneVec{hn::TableLookupLanes(hn::LoadDup128(d, a.x[k][0]), rows),
                     hn::TableLookupLanes(hn::LoadDup128(d, a.x[k][1]), rows),
                     hn::TableLookupLanes(hn::LoadDup128(d, a.x[k][2]), rows)};
    };
    const auto ofB = [&](int k) {
      return LaneVec{hn::LoadDup128(d, b.x[k][0]), hn::LoadDup128(d, b.x[k][1]),
                     hn::LoadDup128(d, b.x[k][2])};
    };
    const LaneVec o = corner(0);
    const LaneVec away = sub(LaneVec{hn::Set(d, static_cast<float>(b.center[0] - a.center[0])),
                                     hn::Set(d, static_cast<float>(b.center[1] - a.center[1])),
                                     hn::Set(d, static_cast<float>(b.center[2] - a.center[2]))},
                             o);
    s1 = sub(corner(1), o);
    s2 = sub(corner(2), o);
    for (int k = 0; k < 3; ++k) {
      const LaneVec p = ofB(k);
      t[k] = {hn::Add(p.x, away.x), hn::Add(p.y, away.y), hn::Add(p.z, away.z)};
    }
    size = hn::Add(hn::Add(hn::Add(sum(o), sum(t[0])), hn::Add(sum(t[1]), sum(t[2]))),
                   hn::Add(hn::Add(sum(s1), sum(s2)), sum(ofB(0))));
  }
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
