// Computes the eigenvectors of eight covariances at once. Included once per SIMD target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_PRINCIPAL_AXES_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_PRINCIPAL_AXES_INL_H_
#undef CORRIDOR_PRINCIPAL_AXES_INL_H_
#else
#define CORRIDOR_PRINCIPAL_AXES_INL_H_
#endif
// clang-format on

#include <limits>

#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Eight symmetric matrices. `Axes8` holds their axes, as `principalAxes` (principal_axes.h)
/// defines them.
struct alignas(64) Covariances8 {
  double entry[6][8];  ///< xx, xy, xz, yy, yz, zz
};
struct alignas(64) Axes8 {
  double axes[3][3][8];  ///< [j][k]: component k of axis j
};

/// Computes the axes of eight covariances as in Eberly, A Robust Eigensolver for 3x3 Symmetric
/// Matrices, 2014. The first eigenvalue computed is the largest or the smallest, whichever is
/// farther from the middle eigenvalue. Its eigenvector is the largest cross product of two rows.
/// The other two eigenvectors are found in the plane orthogonal to the first. For the matrix
/// divided by its trace, minus a third of the identity, the first eigenvalue is ±p·x. Here p² is a
/// sixth of the sum of the squared entries, and x in [√3, 2] is the largest root of x³ − 3x =
/// |determinant|/p³. Newton's method finds x, since the cubic is steep at this root: the start has
/// an error of 1e-3, and the two steps reduce the error to 1e-6 and 1e-12.
HWY_INLINE void principalAxes8(const Covariances8& c, Axes8& out) {
  const hn::CappedTag<double, 8> d;
  using V = hn::Vec<decltype(d)>;
  struct Vec3V {
    V x, y, z;
  };
  const auto set = [&](double x) { return hn::Set(d, x); };
  const auto dot = [](const Vec3V& p, const Vec3V& q) {
    return hn::Add(hn::Add(hn::Mul(p.x, q.x), hn::Mul(p.y, q.y)), hn::Mul(p.z, q.z));
  };
  const auto cross = [](const Vec3V& p, const Vec3V& q) {
    return Vec3V{hn::Sub(hn::Mul(p.y, q.z), hn::Mul(p.z, q.y)),
                 hn::Sub(hn::Mul(p.z, q.x), hn::Mul(p.x, q.z)),
                 hn::Sub(hn::Mul(p.x, q.y), hn::Mul(p.y, q.x))};
  };
  const auto times = [](V s, const Vec3V& p) {
    return Vec3V{hn::Mul(s, p.x), hn::Mul(s, p.y), hn::Mul(s, p.z)};
  };
  const auto select = [](auto mask, const Vec3V& p, const Vec3V& q) {
    return Vec3V{hn::IfThenElse(mask, p.x, q.x), hn::IfThenElse(mask, p.y, q.y),
                 hn::IfThenElse(mask, p.z, q.z)};
  };
  const V zero = hn::Zero(d), one = set(1), third = set(1.0 / 3);
  // Two eigenvalues count as equal if half of their difference is at most `even` times their sum.
  // The reason is that sums of floats are off by some 2^-22, so noise would rotate the axes of a
  // cube. If all three are equal, the axes are those of the coordinates. If two eigenvalues are
  // equal, the axes of their plane are s and t below.
  const V even = set(0x1p-20);
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    const auto load = [&](int k) { return hn::Load(d, c.entry[k] + at); };
    V xx = load(0), xy = load(1), xz = load(2), yy = load(3), yz = load(4), zz = load(5);
    const V trace = hn::Add(hn::Add(xx, yy), zz), inverse = hn::Div(one, trace);
    xx = hn::Sub(hn::Mul(xx, inverse), third);
    yy = hn::Sub(hn::Mul(yy, inverse), third);
    zz = hn::Sub(hn::Mul(zz, inverse), third);
    xy = hn::Mul(xy, inverse);
    xz = hn::Mul(xz, inverse);
    yz = hn::Mul(yz, inverse);
    const V off = hn::Add(hn::Add(hn::Mul(xy, xy), hn::Mul(xz, xz)), hn::Mul(yz, yz));
    const V on = hn::Add(hn::Add(hn::Mul(xx, xx), hn::Mul(yy, yy)), hn::Mul(zz, zz));
    const V p2 = hn::Mul(hn::Add(on, hn::Add(off, off)), set(1.0 / 6)), p = hn::Sqrt(p2);
    const Vec3V row0 = {xx, xy, xz}, row1 = {xy, yy, yz}, row2 = {xz, yz, zz};
    const V determinant = dot(row0, cross(row1, row2));
    const auto largest = hn::Ge(determinant, zero);
    const V p3 = hn::Mul(p2, p);
    // h2 = |determinant|/p³ is at most 2, except for rounding. If all eigenvalues are equal, h2 is
    // 0/0; then the result is the identity.
    const V h2 = hn::Min(hn::Div(hn::Abs(determinant), p3), set(2));
    V x =
        hn::Add(set(1.7320508), hn::Mul(h2, hn::Sub(set(0.1606942), hn::Mul(h2, set(0.0133598)))));
    for (int step = 0; step < 2; ++step) {
      const V square = hn::Mul(x, x);
      x = hn::Div(hn::Add(hn::Mul(hn::Add(x, x), square), h2),
                  hn::Mul(set(3), hn::Sub(square, one)));
    }
    const V lambda = hn::CopySign(hn::Mul(p, x), determinant);
    const Vec3V r0 = {hn::Sub(xx, lambda), xy, xz}, r1 = {xy, hn::Sub(yy, lambda), yz},
                r2 = {xz, yz, hn::Sub(zz, lambda)};
    Vec3V w = cross(r0, r1);
    V square = dot(w, w);
    for (const Vec3V& other : {cross(r1, r2), cross(r2, r0)}) {
      const V otherSquare = dot(other, other);
      const auto larger = hn::Gt(otherSquare, square);
      w = select(larger, other, w);
      square = hn::IfThenElse(larger, otherSquare, square);
    }
    w = times(hn::Div(one, hn::Sqrt(square)), w);
    // An orthonormal basis s, t of the plane orthogonal to w: Duff et al., Building an Orthonormal
    // Basis, Revisited, 2017.
    const V sign = hn::CopySign(one, w.z);
    const V a = hn::Neg(hn::Div(one, hn::Add(sign, w.z)));
    const V b = hn::Mul(hn::Mul(w.x, w.y), a);
    const Vec3V s = {hn::Add(one, hn::Mul(hn::Mul(sign, hn::Mul(w.x, w.x)), a)), hn::Mul(sign, b),
                     hn::Neg(hn::Mul(sign, w.x))};
    const Vec3V t = {b, hn::Add(sign, hn::Mul(hn::Mul(w.y, w.y), a)), hn::Neg(w.y)};
    const Vec3V bs = {dot(row0, s), dot(row1, s), dot(row2, s)},
                bt = {dot(row0, t), dot(row1, t), dot(row2, t)};
    const V m = hn::Mul(set(0.5), hn::Sub(dot(bs, s), dot(bt, t))), n = dot(bs, t);
    const V r = hn::Sqrt(hn::Add(hn::Mul(m, m), hn::Mul(n, n)));
    const auto wide = hn::Ge(m, zero);
    V cosine = hn::IfThenElse(wide, hn::Add(m, r), n),
      sine = hn::IfThenElse(wide, n, hn::Sub(r, m));
    const V length = hn::Sqrt(hn::Add(hn::Mul(cosine, cosine), hn::Mul(sine, sine)));
    const V spread = hn::Add(hn::Add(dot(bs, s), dot(bt, t)), hn::Add(third, third));
    const auto turned = hn::Gt(r, hn::Mul(even, spread));
    const V shorten = hn::Div(one, length);
    cosine = hn::IfThenElse(turned, hn::Mul(cosine, shorten), one);
    sine = hn::IfThenElse(turned, hn::Mul(sine, shorten), zero);
    const Vec3V us = times(cosine, s), ut = times(sine, t);
    const Vec3V u = {hn::Add(us.x, ut.x), hn::Add(us.y, ut.y), hn::Add(us.z, ut.z)};
    // u is the axis of the larger eigenvalue in the plane, v that of the smaller; w × u = v, so
    // that u × v = w.
    const Vec3V v = cross(w, u);
    const Vec3V axes[3] = {select(largest, w, u), select(largest, u, v), select(largest, v, w)};
    // The axes are used only if they are orthonormal and not NaN; else the result is the identity.
    const V limit = set(0x1p-41);
    auto good = hn::And(
        hn::Gt(p, even),
        hn::And(hn::Gt(trace, zero), hn::Lt(inverse, set(std::numeric_limits<double>::max()))));
    good = hn::And(good, hn::Gt(inverse, zero));
    for (int i = 0; i < 3; ++i) {
      good = hn::And(good, hn::Lt(hn::Abs(hn::Sub(dot(axes[i], axes[i]), one)), limit));
      good = hn::And(good, hn::Lt(hn::Abs(dot(axes[i], axes[(i + 1) % 3])), limit));
    }
    for (int j = 0; j < 3; ++j) {
      hn::Store(hn::IfThenElse(good, axes[j].x, j == 0 ? one : zero), d, out.axes[j][0] + at);
      hn::Store(hn::IfThenElse(good, axes[j].y, j == 1 ? one : zero), d, out.axes[j][1] + at);
      hn::Store(hn::IfThenElse(good, axes[j].z, j == 2 ? one : zero), d, out.axes[j][2] + at);
    }
  }
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
