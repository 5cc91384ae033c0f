#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/multiprecision/cpp_int.hpp>

#include "collision/core/transform.h"
#include "collision/predicates/triangle.h"

/// Doubles and what affine maps make of them, as integers on a common power-of-two grid. Signs of
/// polynomials in them are exact; the grid's scale is dropped, since signs don't see it.
namespace corridor::exact {

/// Signed integers of a fixed width that live on the stack. Products that need more bits than
/// `Bits` would wrap: `gridFor` picks a width that holds them.
template <unsigned Bits>
using FixedInt = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<Bits, Bits, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;
using BigInt = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>,
                                             boost::multiprecision::et_off>;

template <class Int>
struct Vector {
  Int x, y, z;
  friend Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  bool isZero() const { return x.is_zero() && y.is_zero() && z.is_zero(); }
};
template <class Int>
Int dot(const Vector<Int>& a, const Vector<Int>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Int>
Vector<Int> cross(const Vector<Int>& a, const Vector<Int>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Int>
int sign(const Int& x) {
  return x.sign();
}

/// mantissa · 2^exponent, |mantissa| < 2^53, trailing zeros removed (so that grids stay coarse);
/// zero: mantissa 0.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = 0;
};
inline Dyadic dyadic(double value) {
  if (value == 0) return {};
  int exponent;
  const double fraction = std::frexp(value, &exponent);
  auto mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(mantissa));
  return {mantissa >> zeros, exponent - 53 + zeros};
}

/// The exponents that occur among the terms (products m·v, and t) of mapped points.
struct Grid {
  int low = std::numeric_limits<int>::max();
  int high = std::numeric_limits<int>::min();  ///< every term is below 2^high in magnitude

  void include(double a, double b) {
    if (a == 0 || b == 0) return;
    const Dyadic x = dyadic(a), y = dyadic(b);
    low = std::min(low, x.exponent + y.exponent);
    high = std::max(high, std::ilogb(a) + std::ilogb(b) + 2);
  }
  void include(const Triangle& triangle, const Transform& X) {
    for (const Vec3& v : triangle)
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) include(X.m(i, k), v[k]);
    for (int i = 0; i < 3; ++i) include(X.t[i], 1.0);
  }
  /// Bits of a coordinate (4 terms, sum below 2^(high + 2)).
  int coordinateBits() const { return high <= low ? 3 : high + 2 - low; }
};

template <class Int>
Int term(double a, double b, const Grid& grid) {
  if (a == 0 || b == 0) return Int(0);
  const Dyadic x = dyadic(a), y = dyadic(b);
  Int value(x.mantissa);
  value *= y.mantissa;
  value <<= static_cast<unsigned>(x.exponent + y.exponent - grid.low);
  return value;
}

/// X·p on the grid, exactly.
template <class Int>
Vector<Int> mapped(const Transform& X, const Vec3& p, const Grid& grid) {
  std::array<Int, 3> c;
  for (int i = 0; i < 3; ++i) {
    c[i] = term<Int>(X.t[i], 1.0, grid);
    for (int k = 0; k < 3; ++k) c[i] += term<Int>(X.m(i, k), p[k], grid);
  }
  return {c[0], c[1], c[2]};
}

}  // namespace corridor::exact
