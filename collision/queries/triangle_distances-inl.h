// Distances of sixteen pairs of triangles, for every SIMD target: foreach_target.h includes this
// file once per target.

// clang-format off
#if defined(CORRIDOR_TRIANGLE_DISTANCES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_TRIANGLE_DISTANCES_INL_H_
#undef CORRIDOR_TRIANGLE_DISTANCES_INL_H_
#else
#define CORRIDOR_TRIANGLE_DISTANCES_INL_H_
#endif
// clang-format on

#include <cmath>

#include "hwy/highway.h"

#include "collision/predicates/triangle_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// For each lane's pair of triangles, the vector from a point of a to a point of b, and its square.
/// The two points are the closest points over all pairs of two edges, or of a corner and a face
/// (Ericson 2005, 5.1.5, 5.1.9).
struct ClosestLanes {
  LaneVec n;
  LaneFloat square;
};
HWY_INLINE ClosestLanes closestLanes(const TrianglePairs& pairs) {
  const LaneTag d;
  using V = LaneFloat;
  using Vec = LaneVec;
  const auto add = [](const Vec& p, const Vec& q) {
    return Vec{hn::Add(p.x, q.x), hn::Add(p.y, q.y), hn::Add(p.z, q.z)};
  };
  const auto scaled = [](const Vec& p, V s) {
    return Vec{hn::Mul(p.x, s), hn::Mul(p.y, s), hn::Mul(p.z, s)};
  };
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0F);
  // Returns a value in [0, 1] whatever x is, also for NaN.
  const auto clamped = [&](V x) {
    return hn::IfThenElse(hn::Gt(x, zero), hn::IfThenElse(hn::Lt(x, one), x, one), zero);
  };
  const auto inverse = [&](V x) { return hn::Div(one, x); };
  // Corners and edges; edge k goes from corner k to the next.
  const Vec s[3] = {{zero, zero, zero}, pairs.s1, pairs.s2};
  const Vec* const t = pairs.t;
  const Vec e[3] = {s[1], sub(s[2], s[1]), sub(s[0], s[2])};
  const Vec f[3] = {sub(t[1], t[0]), sub(t[2], t[1]), sub(t[0], t[2])};
  Vec n = t[0];  // the vector between the closest points found so far
  V least = dot(n, n);
  const auto offer = [&](const Vec& p, auto allowed) {
    const V square = dot(p, p);
    const auto closer = hn::And(allowed, hn::Lt(square, least));  // false for NaN
    n = {hn::IfThenElse(closer, p.x, n.x), hn::IfThenElse(closer, p.y, n.y),
         hn::IfThenElse(closer, p.z, n.z)};
    least = hn::IfThenElse(closer, square, least);
  };
  V ee[3], ff[3], perE[3], perF[3];
  for (int i = 0; i < 3; ++i) {
    ee[i] = dot(e[i], e[i]);
    ff[i] = dot(f[i], f[i]);
    perE[i] = inverse(ee[i]);
    perF[i] = inverse(ff[i]);
  }
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const Vec r = sub(t[k], s[i]);
      const V ef = dot(e[i], f[k]), er = dot(e[i], r), fr = dot(f[k], r);
      const V det = hn::Sub(hn::Mul(ee[i], ff[k]), hn::Mul(ef, ef));
      const V x = clamped(hn::Div(hn::Sub(hn::Mul(er, ff[k]), hn::Mul(ef, fr)), det));
      const V y = clamped(hn::Mul(hn::Sub(hn::Mul(ef, x), fr), perF[k]));
      const V z = clamped(hn::Mul(hn::Add(hn::Mul(ef, y), er), perE[i]));
      offer(add(r, sub(scaled(f[k], y), scaled(e[i], z))), hn::FirstN(d, kTriangleLanes));
    }
  // Offers the vectors between the corners `ps` and their orthogonal projections onto the plane of
  // a face, if the projections lie inside the face. The face has the corner `at0`; u and v are its
  // edges from that corner.
  const auto faces = [&](const Vec* ps, const Vec& at0, const Vec& u, const Vec& v, V uu, V vv,
                         bool flip) {
    const V uv = dot(u, v);
    const V per = inverse(hn::Sub(hn::Mul(uu, vv), hn::Mul(uv, uv)));
    for (int i = 0; i < 3; ++i) {
      const Vec w = sub(ps[i], at0);
      const V wu = dot(w, u), wv = dot(w, v);
      const V x = hn::Mul(hn::Sub(hn::Mul(vv, wu), hn::Mul(uv, wv)), per),
              y = hn::Mul(hn::Sub(hn::Mul(uu, wv), hn::Mul(uv, wu)), per);
      const auto inside =
          hn::And(hn::And(hn::Ge(x, zero), hn::Ge(y, zero)), hn::Le(hn::Add(x, y), one));
      if (hn::AllFalse(d, inside)) continue;
      const Vec p = sub(w, add(scaled(u, x), scaled(v, y)));
      offer(flip ? Vec{hn::Neg(p.x), hn::Neg(p.y), hn::Neg(p.z)} : p, inside);
    }
  };
  faces(t, s[0], s[1], s[2], ee[0], ee[2], false);
  faces(s, t[0], f[0], sub(t[2], t[0]), ff[0], ff[2], true);
  return {n, least};
}

/// Bounds the distances of sixteen pairs of triangles. `upper` is the distance of a point of a from
/// a point of b, and therefore an upper bound. `lower` is the gap along the line through these two
/// points, and therefore a lower bound. Both include all rounding, and `error`: the distance by
/// which the given corners may be off, for both triangles together. For crossing triangles `upper`
/// is valid and `lower` is 0. If nothing can be proved, the range is [0, inf].
///
/// The points are the closest of two edges, or of a corner and a face (Ericson 2005, 5.1.5, 5.1.9).
/// Up to rounding they are points of the triangles, and any direction gives a lower bound. So the
/// proof does not depend on how accurately the closest points were found.
///
/// Rounding, with u = 2^-24 and D the pair's size (`TrianglePairs`):
/// * All coordinates are relative to a corner of a's triangle. Each corner is off by 3u·D per
///   coordinate.
/// * The evaluation of a point of an edge or a face adds less than 6u·D. Parameters whose sum is
///   off by u move the point by u·D. Two points, their difference and its length are therefore off
///   by √3(2·10 + 2)u·D < 40u·D.
/// * Projections onto a direction n are off by 3u + √3·3u of |n|·D for each triangle, or 20u·D with
///   the quotient.
/// * Products that underflow, flushed or not, lose less than 2^-124 per sum. If all products
///   underflow, this loses a length of 2^-62. A length above 2^-50 loses 2^-25 of itself, and a
///   projection onto such an n loses less than u·|n|·D. Below a length of 2^-50, `lower` is 0.
HWY_INLINE void triangleDistances(const TriangleCorners& a, const TriangleCorners& b,
                                  const TriangleNumbers& numbers, float error,
                                  float* HWY_RESTRICT lower, float* HWY_RESTRICT upper) {
  const LaneTag d;
  using V = LaneFloat;
  const V zero = hn::Zero(d), infinite = hn::Set(d, HUGE_VALF);
  for (std::size_t at = 0; at < 16; at += kTriangleLanes) {
    const TrianglePairs pairs(a, b, numbers, at);
    const LaneVec& s1 = pairs.s1;
    const LaneVec& s2 = pairs.s2;
    const LaneVec* const t = pairs.t;
    const auto [n, least] = closestLanes(pairs);
    const V D = pairs.size;
    // Squares don't overflow. Products of squares in the parameters may: the result is a NaN, which
    // is clamped, or counts as not inside.
    const auto known = hn::Lt(D, hn::Set(d, 0x1p50F));
    const V off = hn::Add(hn::Set(d, error), hn::Mul(hn::Set(d, 48 * 0x1p-24F), D));
    const V length = hn::Sqrt(least);
    const V up = hn::Add(hn::Mul(hn::Add(length, hn::Set(d, 0x1p-60F)), hn::Set(d, 1 + 0x1p-20F)),
                         hn::Mul(off, hn::Set(d, 1 + 0x1p-20F)));
    const V gap =
        hn::Sub(min3(dot(n, t[0]), dot(n, t[1]), dot(n, t[2])), max3(zero, dot(n, s1), dot(n, s2)));
    const V low = hn::Sub(hn::Mul(hn::Div(gap, length), hn::Set(d, 1 - 0x1p-20F)), off);
    const auto certain =
        hn::And(known, hn::And(hn::Gt(low, zero), hn::Gt(length, hn::Set(d, 0x1p-50F))));
    hn::Store(hn::IfThenElse(certain, low, zero), d, lower + at);
    hn::Store(hn::IfThenElse(hn::And(known, hn::Lt(up, infinite)), up, infinite), d, upper + at);
  }
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
