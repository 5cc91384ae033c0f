#pragma once

#include <array>
#include <cmath>
#include <quadmath.h>

#include <Eigen/Geometry>

#include "collision/core/transform.h"

/// Vectors, matrices and angles in 128-bit floating point, for the audit, which shares no
/// arithmetic with Corridor. Vectors and matrices are templates, because the same formulas also run
/// in long double, where many samples are needed but few digits.
namespace corridor::audit {

__extension__ typedef __float128 Quad;

inline Quad sine(Quad x) {
  return sinq(x);
}
inline Quad cosine(Quad x) {
  return cosq(x);
}
inline Quad root(Quad x) {
  return sqrtq(x);
}
inline long double sine(long double x) {
  return std::sin(x);
}
inline long double cosine(long double x) {
  return std::cos(x);
}
inline long double root(long double x) {
  return std::sqrt(x);
}
template <class S>
S magnitude(S x) {
  return x < 0 ? -x : x;
}

template <class S>
struct Vec {
  std::array<S, 3> c{S(0), S(0), S(0)};

  Vec() = default;
  Vec(S x, S y, S z) : c{x, y, z} {}
  explicit Vec(const Vec3& v) : c{S(v[0]), S(v[1]), S(v[2])} {}
  template <class Other>
  explicit Vec(const Vec<Other>& v) : c{S(v[0]), S(v[1]), S(v[2])} {}

  const S& operator[](std::size_t i) const { return c[i]; }
  S& operator[](std::size_t i) { return c[i]; }
  Vec operator+(const Vec& o) const { return {c[0] + o[0], c[1] + o[1], c[2] + o[2]}; }
  Vec operator-(const Vec& o) const { return {c[0] - o[0], c[1] - o[1], c[2] - o[2]}; }
  Vec operator-() const { return {-c[0], -c[1], -c[2]}; }
  Vec operator*(S s) const { return {c[0] * s, c[1] * s, c[2] * s}; }

  Vec3 rounded() const {
    return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
  }
};

template <class S>
S dot(const Vec<S>& a, const Vec<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class S>
Vec<S> cross(const Vec<S>& a, const Vec<S>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class S>
S length(const Vec<S>& a) {
  return root(dot(a, a));
}
/// Returns the vector scaled to length 1; the zero vector is returned as it is.
template <class S>
Vec<S> unit(const Vec<S>& a) {
  S largest = 0;
  for (const S& x : a.c) largest = magnitude(x) > largest ? magnitude(x) : largest;
  if (largest == 0) return a;
  const Vec<S> b = a * (1 / largest);  // without this, squares of tiny or huge numbers would under-
                                       // or overflow
  return b * (1 / length(b));
}

template <class S>
struct Mat {
  std::array<Vec<S>, 3> row{Vec<S>{1, 0, 0}, Vec<S>{0, 1, 0}, Vec<S>{0, 0, 1}};

  Vec<S> operator*(const Vec<S>& v) const {
    return {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
  }
  Mat operator*(const Mat& o) const {
    const Mat t = o.transposed();
    Mat product;
    for (std::size_t i = 0; i < 3; ++i) product.row[i] = t * row[i];
    return product;
  }
  Mat transposed() const {
    Mat t;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) t.row[i][k] = row[k][i];
    return t;
  }
};

/// The map x ↦ R·x + p.
template <class S>
struct Pose {
  Mat<S> R;
  Vec<S> p;

  Vec<S> operator*(const Vec<S>& v) const { return R * v + p; }
  Pose operator*(const Pose& o) const { return {R * o.R, R * o.p + p}; }
  Pose inverse() const {
    const Mat<S> t = R.transposed();
    return {t, -(t * p)};
  }
};

/// Returns the rotation about the unit axis k by the angle with sine s and cosine c.
template <class S>
Mat<S> turnAbout(const Vec<S>& k, S s, S c) {
  const S v = 1 - c;
  Mat<S> R;
  R.row[0] = {c + v * k[0] * k[0], v * k[0] * k[1] - s * k[2], v * k[0] * k[2] + s * k[1]};
  R.row[1] = {v * k[0] * k[1] + s * k[2], c + v * k[1] * k[1], v * k[1] * k[2] - s * k[0]};
  R.row[2] = {v * k[0] * k[2] - s * k[1], v * k[1] * k[2] + s * k[0], c + v * k[2] * k[2]};
  return R;
}

/// Returns the rotation matrix of a quaternion (x, y, z, w) of any norm above 0.
template <class S>
Mat<S> rotationOf(const std::array<S, 4>& q) {
  const S k = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const S x = q[0], y = q[1], z = q[2], w = q[3];
  Mat<S> R;
  R.row[0] = {1 - k * (y * y + z * z), k * (x * y - w * z), k * (x * z + w * y)};
  R.row[1] = {k * (x * y + w * z), 1 - k * (x * x + z * z), k * (y * z - w * x)};
  R.row[2] = {k * (x * z - w * y), k * (y * z + w * x), 1 - k * (x * x + y * y)};
  return R;
}

/// A number of some 226 bits, the sum high + low. It can hold angles of up to 10^30 rad.
struct Twofold {
  Quad high = 0, low = 0;
};
/// Returns a + b exactly (Knuth's TwoSum).
inline Twofold sum(Quad a, Quad b) {
  const Quad s = a + b, c = s - a;
  return {s, (a - (s - c)) + (b - c)};
}
/// Returns the angle minus whole revolutions, in [−π, π], to 33 digits.
inline Quad withoutTurns(Twofold angle) {
  static const Quad pi = acosq(-1), piLow = sinq(pi);  // π = pi + sin(pi) to twice the digits
  const Quad turns = roundq(angle.high / (2 * pi));
  const Quad product = turns * 2 * pi, error = fmaq(turns, 2 * pi, -product);
  const Quad left = (angle.high - product) + ((angle.low - error) - turns * 2 * piLow);
  return left > pi ? left - 2 * pi : left < -pi ? left + 2 * pi : left;
}

}  // namespace corridor::audit
