// A filter in float for sixteen pairs of triangles. Highway's foreach_target.h includes this file
// once per SIMD target.

// clang-format off
#if defined(CORRIDOR_TRIANGLE_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_TRIANGLE_FILTER_INL_H_
#undef CORRIDOR_TRIANGLE_FILTER_INL_H_
#else
#define CORRIDOR_TRIANGLE_FILTER_INL_H_
#endif
// clang-format on

#include <cmath>

#include "hwy/highway.h"

#include "collision/predicates/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Tests sixteen pairs of triangles and returns one bit per pair: set if the pair may touch. A
/// clear bit proves that the triangles are more than `error` + `pad` apart.
/// @param error a bound on the errors of the given corners: the sum of the bounds of both
/// triangles.
/// @param pad a clearance to prove in addition. Both `error` and `pad` are in the unit of the
/// corners.
///
/// Method: separating axes. The axes are the normals of both triangles, and the nine cross products
/// of an edge of a and an edge of b.
///
/// Rounding, with u = 2^-24 and D the `size` of a pair (`TrianglePairs`): corners are off by 3u·D
/// per coordinate. A vector L of any direction separates the triangles if their projections onto it
/// are disjoint.
/// * The rounding errors of the two projections together are less than 2(3u + 3u)·|L|₁·D. The error
///   of the given corners adds |L|₂·error.
/// * The code assumes that both ends of an edge e have the same projection onto L = e × f. The
///   difference of the two projections is L·e, which is 0 except for the rounding of L. This
///   rounding is |δL| ≤ 2u|e||f| per coordinate, so the difference is below 2√3·u|e||f|·√3D.
/// * With |L|₁ ≤ √3|L|₂ and |L|₂ ≤ |e||f|(1 + 4u), the sum of these errors is below |e||f|·(error +
///   28u·D). The same holds for normals. The code uses 40u in place of 28u, and |e|₁ ≥ |e|₂ as the
///   length of an edge.
/// * Products that underflow lose less than 2^-124 times an edge length below 2^30, whether or not
///   they are flushed to zero.
///
/// `pad` is multiplied by the true length of each axis.
HWY_INLINE unsigned touchingTriangles(const TriangleCorners& a, const TriangleCorners& b,
                                      const TriangleNumbers& numbers, float error, float pad = 0) {
  const LaneTag d;
  using V = LaneFloat;
  using Vec = LaneVec;
  // Returns pad·|L|, rounded up. 2^-60 is added to |L|, because squares of lengths below 2^-63
  // vanish.
  const bool padded = pad > 0;
  const auto padding = [&](const Vec& L) {
    return hn::Mul(hn::Set(d, pad * (1 + 0x1p-20F)),
                   hn::Add(hn::Sqrt(dot(L, L)), hn::Set(d, 0x1p-60F)));
  };
  unsigned mask = 0;
  const V zero = hn::Zero(d);
  for (std::size_t at = 0; at < 16; at += kTriangleLanes) {
    const TrianglePairs pairs(a, b, numbers, at);
    const Vec &e1 = pairs.s1, &e2 = pairs.s2, &p0 = pairs.t[0], &p1 = pairs.t[1], &p2 = pairs.t[2];
    const Vec f1 = sub(p1, p0), f2 = sub(p2, p0);
    const Vec ea[3] = {e1, sub(e2, e1), e2};
    const Vec fb[3] = {f1, sub(p2, p1), f2};
    V le[3], lf[3];
    for (int i = 0; i < 3; ++i) {
      le[i] = norm1(ea[i]);
      lf[i] = norm1(fb[i]);
    }
    // D < 2^30: products of three such numbers are far from overflow.
    const V D = pairs.size;
    const V per = hn::IfThenElse(hn::Lt(D, hn::Set(d, 0x1p30F)),
                                 hn::MulAdd(hn::Set(d, 40 * 0x1p-24F), D, hn::Set(d, error)),
                                 hn::Set(d, HUGE_VALF));
    const V tiny = hn::Set(d, 0x1p-90F);  // covers underflow
    // The plane of a.
    const Vec na = cross(e1, e2);
    const V s0 = dot(na, p0), s1 = dot(na, p1), s2 = dot(na, p2);
    V gap = hn::Max(min3(s0, s1, s2), hn::Neg(max3(s0, s1, s2)));
    V margin = hn::MulAdd(per, hn::Mul(le[0], le[2]), tiny);
    if (padded) margin = hn::Add(margin, padding(na));
    auto open = hn::Not(hn::Gt(gap, margin));
    // The plane of b.
    const Vec nb = cross(f1, f2);
    const V h = dot(nb, p0), t1 = dot(nb, e1), t2 = dot(nb, e2);
    gap = hn::Max(hn::Sub(min3(zero, t1, t2), h), hn::Sub(h, max3(zero, t1, t2)));
    margin = hn::MulAdd(per, hn::Mul(lf[0], lf[2]), tiny);
    if (padded) margin = hn::Add(margin, padding(nb));
    open = hn::AndNot(hn::Gt(gap, margin), open);
    if (!hn::AllFalse(d, open)) {
      // The axis is orthogonal to edge i of a and to edge j of b. Both ends of such an edge have
      // the same projection, so one end and the opposite corner give the projection of the
      // triangle.
      for (int i = 0; i < 3; ++i) {
        const V reach = hn::Mul(per, le[i]);
        for (int j = 0; j < 3; ++j) {
          const Vec L = cross(ea[i], fb[j]);
          const V s = i == 0 ? dot(L, e2) : dot(L, e1);  // the projections of a are s and 0
          const V q0 = dot(L, j == 1 ? p1 : p0), q1 = dot(L, j == 0 ? p2 : j == 1 ? p0 : p1);
          gap = hn::Max(hn::Sub(hn::Min(q0, q1), hn::Max(s, zero)),
                        hn::Sub(hn::Min(s, zero), hn::Max(q0, q1)));
          margin = hn::MulAdd(reach, lf[j], tiny);
          if (padded) margin = hn::Add(margin, padding(L));
          open = hn::AndNot(hn::Gt(gap, margin), open);
        }
      }
    }
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, open, bits);
    mask |= (static_cast<unsigned>(bits[0]) | static_cast<unsigned>(bits[1]) << 8) << at;
  }
  return mask;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
