#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>

#include <boost/multiprecision/cpp_int.hpp>

#include "collision/core/transform.h"
#include "collision/predicates/small_int.h"
#include "collision/predicates/triangle.h"

/// Points under affine maps as integers on a common power-of-two grid. The integers are exact, and
/// so are the signs of polynomials in these integers. The integers are in units of the grid. The
/// unit is a factor above 0, so it changes no sign.
namespace corridor::exact {

/// Signed integers of a fixed width, on the stack. Results of more than `Bits` bits would wrap;
/// `withIntegersFor` picks a width that is large enough for all results.
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
/// The type of the result may be wider than the type of the coordinates (small_int.h).
template <class A, class B>
auto dot(const Vector<A>& a, const Vector<B>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class Int>
auto cross(const Vector<Int>& a, const Vector<Int>& b) {
  return Vector<decltype(a.x * b.x)>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                                     a.x * b.y - a.y * b.x};
}
template <class Int>
int sign(const Int& x) {
  return x.sign();
}
template <class Int>
const Int& coordinate(const Vector<Int>& v, int i) {
  return i == 0 ? v.x : i == 1 ? v.y : v.z;
}
/// Returns the index of a coordinate axis such that the projection along this axis is one to one on
/// planes with normal n. @pre n ≠ 0.
template <class Int>
int dropAxis(const Vector<Int>& n) {
  return !n.x.is_zero() ? 0 : !n.y.is_zero() ? 1 : 2;
}
/// The corners of a triangle.
template <class Int>
using TriangleCorners = std::array<Vector<Int>, 3>;

/// A double as mantissa · 2^exponent with |mantissa| < 2^53. The mantissa is 0 for zero. Otherwise
/// it is odd, which keeps grids coarse.
struct Dyadic {
  std::int64_t mantissa = 0;
  int exponent = 0;
};
inline Dyadic dyadic(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto field = static_cast<int>(bits >> 52 & 0x7ff);
  std::uint64_t mantissa = bits & 0xfffffffffffffULL;
  if (field) mantissa |= 1ULL << 52;
  if (!mantissa) return {};
  const int zeros = std::countr_zero(mantissa);
  const auto odd = static_cast<std::int64_t>(mantissa >> zeros);
  return {bits >> 63 ? -odd : odd, std::max(field, 1) - 1075 + zeros};
}

/// Up to three points, and the affine map to apply to them, as dyadic numbers.
struct MappedPoints {
  std::array<std::array<Dyadic, 3>, 3> m, corners;
  std::array<Dyadic, 3> t;
  std::size_t count;  ///< number of points

  MappedPoints(const Transform& X, std::span<const Vec3> points) : count(points.size()) {
    for (int i = 0; i < 3; ++i) {
      t[i] = dyadic(X.t[i]);
      for (int k = 0; k < 3; ++k) m[i][k] = dyadic(X.m(i, k));
    }
    for (std::size_t p = 0; p < count; ++p)
      for (int k = 0; k < 3; ++k) corners[p][k] = dyadic(points[p][k]);
  }
};

/// The range of exponents among the terms (products m·v, and t) of mapped points.
struct Grid {
  int low = std::numeric_limits<int>::max();   ///< every term is a multiple of 2^low
  int high = std::numeric_limits<int>::min();  ///< every term is below 2^high in magnitude

  void include(const Dyadic& a, const Dyadic& b) {
    if (!a.mantissa || !b.mantissa) return;
    const auto bits = [](std::int64_t x) {
      return 64 - std::countl_zero(static_cast<std::uint64_t>(std::abs(x)));
    };
    low = std::min(low, a.exponent + b.exponent);
    high = std::max(high, a.exponent + bits(a.mantissa) + b.exponent + bits(b.mantissa));
  }
  void include(const MappedPoints& points) {
    for (std::size_t p = 0; p < points.count; ++p)
      for (int k = 0; k < 3; ++k)
        for (int i = 0; i < 3; ++i) include(points.m[i][k], points.corners[p][k]);
    for (int i = 0; i < 3; ++i) include(points.t[i], {1, 0});
  }
  /// Returns how many bits a mapped coordinate needs, in units of the grid. The coordinate is a sum
  /// of 4 terms, so its magnitude is below 2^(high + 2).
  int coordinateBits() const { return high <= low ? 3 : high + 2 - low; }
};

/// Calls `run.template operator()<Int>()` with the fastest integer type that is wide enough for
/// the orientation (a determinant) of four points of the grid, and returns its result.
///
/// Bits: with coordinates below 2^k, differences are below 2^(k+1), cross products below 2^(2k+3),
/// and orientations below 3·2^(k+1)·2^(2k+3) < 2^(3k+6). So 3k + 6 bits hold every intermediate
/// value.
template <class Run>
auto withIntegersFor(const Grid& grid, const Run& run) {
  const int k = grid.coordinateBits(), bits = 3 * k + 6;
  // Int64: differences below 2^62, cross products below 2^125, orientations below 2^189.
  if (k <= 61) return run.template operator()<Int64>();
  if (bits <= 512) return run.template operator()<FixedInt<512>>();
  if (bits <= 1024) return run.template operator()<FixedInt<1024>>();
  return run.template operator()<BigInt>();
}

template <class Int>
Int term(const Dyadic& a, const Dyadic& b, const Grid& grid) {
  if (!a.mantissa || !b.mantissa) return Int(0);
  Int value(a.mantissa);
  value *= Int(b.mantissa);
  value <<= static_cast<unsigned>(a.exponent + b.exponent - grid.low);
  return value;
}

/// Returns the p-th point under its map, exactly, in units of the grid.
template <class Int>
Vector<Int> mapped(const MappedPoints& points, std::size_t p, const Grid& grid) {
  std::array<Int, 3> c;
  for (int i = 0; i < 3; ++i) {
    c[i] = term<Int>(points.t[i], {1, 0}, grid);
    for (int k = 0; k < 3; ++k) c[i] += term<Int>(points.m[i][k], points.corners[p][k], grid);
  }
  return {c[0], c[1], c[2]};
}

/// Returns the three corners of a triangle under its map, exactly, in units of the grid.
template <class Int>
TriangleCorners<Int> mapped(const MappedPoints& triangle, const Grid& grid) {
  return {mapped<Int>(triangle, 0, grid), mapped<Int>(triangle, 1, grid),
          mapped<Int>(triangle, 2, grid)};
}

}  // namespace corridor::exact
