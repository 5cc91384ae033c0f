#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "collision/predicates/exact_number.h"
#include "collision/queries/triangle_intersection.h"

namespace corridor {
namespace {

using exact::coordinate;
using exact::cross;
using exact::dot;
using exact::dropAxis;
using exact::sign;
using exact::TriangleCorners;
using exact::Vector;

/// Returns numerator/denominator·2^exponent rounded to the nearest double, so that equal values
/// give equal doubles.
template <class Int>
double roundedQuotient(Int numerator, Int denominator, int exponent) {
  if (numerator.is_zero()) return 0;
  const bool negative = (numerator.sign() < 0) != (denominator.sign() < 0);
  numerator = abs(numerator);
  denominator = abs(denominator);
  // The quotient has 63 or 64 bits; 53 of them remain after rounding. If there is a remainder, the
  // last bit is set as a sticky bit. The sticky bit is below the bit that is half an ulp of the
  // result. It therefore changes the rounding only if the quotient without its remainder would be a
  // tie.
  const int shift = 63 - (static_cast<int>(msb(numerator)) - static_cast<int>(msb(denominator)));
  if (shift > 0)
    numerator <<= static_cast<unsigned>(shift);
  else
    denominator <<= static_cast<unsigned>(-shift);
  Int quotient, rest;
  divide_qr(numerator, denominator, quotient, rest);
  const auto bits = static_cast<std::uint64_t>(quotient) | (rest.is_zero() ? 0u : 1u);
  const double value = std::ldexp(static_cast<double>(bits), exponent - shift);
  return negative ? -value : value;
}

/// The corners of the intersection of two triangles. For each edge, the part of the edge that is
/// inside the other triangle is found. The ends of these parts are the corners.
template <class Int>
class ExactSection {
 public:
  ExactSection(const TriangleCorners<Int>& a, const TriangleCorners<Int>& b, int exponent)
      : exponent_(exponent) {
    const Vector<Int> nA = cross(a[1] - a[0], a[2] - a[0]), nB = cross(b[1] - b[0], b[2] - b[0]);
    for (int i = 0; i < 3; ++i) {
      clip(a[i], a[(i + 1) % 3], b, nB);
      clip(b[i], b[(i + 1) % 3], a, nA);
    }
  }

  /// Returns the two corners that are farthest apart.
  Segment longest() const {
    Segment best{found_.at(0), found_.at(0)};
    double length = 0;
    for (const Vec3& p : found_)
      for (const Vec3& q : found_)
        if (const double l = (q - p).stableNorm(); l > length) {
          length = l;
          best = {p, q};
        }
    return best;
  }

 private:
  /// Adds the point p + (q − p)·numerator/denominator.
  void add(const Vector<Int>& p, const Vector<Int>& q, const Int& numerator,
           const Int& denominator) {
    const Vector<Int> d = q - p;
    Vec3 x;
    for (int i = 0; i < 3; ++i)
      x[i] = roundedQuotient<Int>(coordinate(p, i) * denominator + coordinate(d, i) * numerator,
                                  denominator, exponent_);
    found_.push_back(x);
  }
  void add(const Vector<Int>& p) { add(p, p, Int(0), Int(1)); }

  /// Tests whether x is between r and s. @pre All three are on one line.
  static bool between(const Vector<Int>& x, const Vector<Int>& r, const Vector<Int>& s) {
    for (int i = 0; i < 3; ++i) {
      const Int &c = coordinate(x, i), &d = coordinate(r, i), &e = coordinate(s, i);
      if (c < std::min(d, e) || c > std::max(d, e)) return false;
    }
    return true;
  }

  /// Adds the ends of the intersection of the closed segments pq and rs; each segment may be a
  /// point.
  void meet(const Vector<Int>& p, const Vector<Int>& q, const Vector<Int>& r,
            const Vector<Int>& s) {
    const Vector<Int> d = q - p, e = s - r, f = r - p, n = cross(d, e);
    if (!n.isZero()) {
      if (sign(dot(n, f)) != 0) return;
      // p + d·t = r + e·u gives t·n = f × e and u·n = f × d. All three vectors are parallel to n.
      const int k = dropAxis(n);
      const Int& whole = coordinate(n, k);
      const Int t = coordinate(cross(f, e), k), u = coordinate(cross(f, d), k);
      const auto inside = [&](const Int& x) {
        return x.is_zero() || (x.sign() == whole.sign() && abs(x) <= abs(whole));
      };
      if (inside(t) && inside(u)) add(p, q, t, whole);
      return;
    }
    const Vector<Int>& line = d.isZero() ? e : d;
    if (!cross(line, f).isZero()) return;
    for (const Vector<Int>* x : {&p, &q})
      if (between(*x, r, s)) add(*x);
    for (const Vector<Int>* x : {&r, &s})
      if (between(*x, p, q)) add(*x);
  }

  /// Adds the ends of the part of the segment pq inside the triangle t with normal n (zero if t is
  /// degenerate).
  void clip(const Vector<Int>& p, const Vector<Int>& q, const TriangleCorners<Int>& t,
            const Vector<Int>& n) {
    const Int sideP = dot(n, p - t[0]), sideQ = dot(n, q - t[0]);
    if (sign(sideP) * sign(sideQ) > 0) return;
    if (sideP.is_zero() && sideQ.is_zero()) {  // pq is in the plane of t, or t is degenerate
      for (int i = 0; i < 3; ++i) meet(p, q, t[i], t[(i + 1) % 3]);
      for (const Vector<Int>* x : {&p, &q})
        if (!n.isZero() && inside(*x, n, t)) add(*x);
      return;
    }
    // The line crosses the plane in one point. That point is in the triangle unless the line passes
    // left of one edge and right of another.
    const Vector<Int> d = q - p;
    bool positive = false, negative = false;
    for (int i = 0; i < 3; ++i) {
      const int s = sign(dot(d, cross(t[i] - p, t[(i + 1) % 3] - p)));
      positive |= s > 0;
      negative |= s < 0;
    }
    if (!(positive && negative)) add(p, q, sideP, Int(sideP - sideQ));
  }

  /// Tests whether x, a point in the plane of t, is inside t. @pre t is not degenerate.
  static bool inside(const Vector<Int>& x, const Vector<Int>& n, const TriangleCorners<Int>& t) {
    const int k = dropAxis(n);
    for (int i = 0; i < 3; ++i) {
      const Int turn = coordinate(cross(t[(i + 1) % 3] - t[i], x - t[i]), k);
      if (turn.sign() * coordinate(n, k).sign() < 0) return false;
    }
    return true;
  }

  int exponent_;
  std::vector<Vec3> found_;
};

template <class Int>
Segment longestSegment(const exact::MappedPoints& a0, const exact::MappedPoints& b0,
                       const exact::Grid& grid) {
  return ExactSection<Int>(exact::mapped<Int>(a0, grid), exact::mapped<Int>(b0, grid),
                           grid.high <= grid.low ? 0 : grid.low)
      .longest();
}

}  // namespace

Segment triangleIntersectionExact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                                  const Transform& X_WB) {
  const exact::MappedPoints cornersA(X_WA, a), cornersB(X_WB, b);
  exact::Grid grid;
  grid.include(cornersA);
  grid.include(cornersB);
  // Let coordinates be below 2^k. Then signed volumes are below 2^(3k+6) (exact_number.h), and a
  // point's numerators below 2^(4k+9). The division shifts a numerator up only if the numerator has
  // few bits compared with the denominator. The shifted numerator has at most 3k + 72 bits.
  const int bits = 4 * grid.coordinateBits() + 80;
  if (bits <= 1024) return longestSegment<exact::FixedInt<1024>>(cornersA, cornersB, grid);
  return longestSegment<exact::BigInt>(cornersA, cornersB, grid);
}

}  // namespace corridor
