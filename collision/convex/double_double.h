#pragma once

#include <cmath>

namespace corridor {

/// A number of some 104 bits: an unevaluated sum hi + lo of two doubles, with |lo| ≤ 2^-53·|hi|.
/// Used where plain doubles are too coarse: to measure distances of triangles, to find candidates
/// for separating axes, and for the lower bounds of distances. convex_distance.cpp bounds the
/// rounding errors of this arithmetic.
///
/// Sources: Dekker 1971; Knuth, TAOCP 2, 4.2.2; accurate addition as in Joldes, Muller, Popescu
/// 2017, algorithm 6.
struct DoubleDouble {
  double hi = 0, lo = 0;

  DoubleDouble() = default;
  DoubleDouble(double x) : hi(x) {}  // NOLINT: every double is a DoubleDouble
  explicit operator double() const { return hi; }

  static DoubleDouble quickSum(double a, double b) {  // |a| ≥ |b|
    DoubleDouble s(a + b);
    s.lo = b - (s.hi - a);
    return s;
  }
  static DoubleDouble sum(double a, double b) {
    DoubleDouble s(a + b);
    const double t = s.hi - a;
    s.lo = (a - (s.hi - t)) + (b - t);
    return s;
  }
  static DoubleDouble product(double a, double b) {
    DoubleDouble p(a * b);
    p.lo = std::fma(a, b, -p.hi);
    return p;
  }

  DoubleDouble operator-() const {
    DoubleDouble x;
    x.hi = -hi;
    x.lo = -lo;
    return x;
  }
  friend DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble s = sum(a.hi, b.hi), t = sum(a.lo, b.lo);
    const DoubleDouble v = quickSum(s.hi, s.lo + t.hi);
    return quickSum(v.hi, t.lo + v.lo);
  }
  friend DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) { return a + (-b); }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble p = product(a.hi, b.hi);
    return quickSum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double q1 = a.hi / b.hi;
    const DoubleDouble r = a - b * DoubleDouble(q1);
    const double q2 = r.hi / b.hi;
    const double q3 = (r - b * DoubleDouble(q2)).hi / b.hi;
    return quickSum(q1, q2) + DoubleDouble(q3);
  }
  friend DoubleDouble sqrt(const DoubleDouble& a) {  // one Newton step from the root of hi
    if (!(a.hi > 0)) return DoubleDouble(std::sqrt(a.hi));
    const double y = std::sqrt(a.hi);
    return DoubleDouble(y) + DoubleDouble((a - product(y, y)).hi / (2 * y));
  }
  friend bool operator<(const DoubleDouble& a, const DoubleDouble& b) {
    return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo);
  }
  friend bool operator>(const DoubleDouble& a, const DoubleDouble& b) { return b < a; }
  friend bool operator==(const DoubleDouble& a, const DoubleDouble& b) {
    return a.hi == b.hi && a.lo == b.lo;
  }
};

}  // namespace corridor
