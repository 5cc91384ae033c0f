#include "tests/support/reference_distance.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <boost/multiprecision/cpp_int.hpp>

namespace corridor::test {
namespace {

// Integers are used because no fixed number of digits is enough. For example, a triangle may have
// two corners 2^-1074 apart and the third one some metres away: its two long sides differ only by
// 2^-1074.
namespace mp = boost::multiprecision;
using WholeNumber = mp::number<mp::cpp_int::backend_type, mp::et_off>;
using P = std::array<WholeNumber, 3>;

/// A squared distance: over / under, with under > 0.
struct Quotient {
  WholeNumber over, under = 1;
};
bool operator<(const Quotient& a, const Quotient& b) {
  return a.over * b.under < b.over * a.under;
}

P minus(const P& a, const P& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
WholeNumber dot(const P& a, const P& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
P cross(const P& a, const P& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
WholeNumber square(const P& d) {
  return dot(d, d);
}

/// Returns the smaller of 0 and the exponent of the lowest bit of x that is not zero.
int lastBit(double x) {
  int exponent = 0;
  const auto bits =
      static_cast<unsigned long long>(std::ldexp(std::frexp(std::abs(x), &exponent), 53));
  return bits == 0 ? 0 : std::min(0, exponent - 53 + std::countr_zero(bits));
}

/// Converts world points to integers: their coordinates in units of 2^(2·unit_).
class Grid {
 public:
  void cover(double x) { unit_ = std::min(unit_, lastBit(x)); }
  void cover(const Vec3& p) {
    for (const double x : p) cover(x);
  }
  void cover(const Transform& X) {
    for (int i = 0; i < 9; ++i) cover(X.m.data()[i]);
    cover(X.t);
  }
  P mapped(const Transform& X, const Vec3& p) const {
    P q;
    for (int i = 0; i < 3; ++i) {
      q[i] = integer(X.t[i]) * integer(1);
      for (int k = 0; k < 3; ++k) q[i] += integer(X.m(i, k)) * integer(p[k]);
    }
    return q;
  }
  /// Returns the square root of a squared distance, in world units. It is rounded from a root of
  /// some 75 bits.
  double distance(const Quotient& squared) const {
    const auto bits = [](const WholeNumber& x) { return x == 0 ? 0 : static_cast<int>(msb(x)); };
    const int shift = (150 + bits(squared.under) - bits(squared.over)) / 2;
    const WholeNumber over = shift < 0 ? squared.over >> -2 * shift : squared.over << 2 * shift;
    const WholeNumber root = sqrt(WholeNumber(over / squared.under));
    return std::ldexp(root.convert_to<double>(), 2 * unit_ - shift);
  }

 private:
  WholeNumber integer(double x) const {
    int exponent = 0;
    const auto bits = static_cast<long long>(std::ldexp(std::frexp(x, &exponent), 53));
    const int shift = exponent - 53 - unit_;  // if negative, only zero bits are shifted out
    return shift < 0 ? WholeNumber(bits >> -shift) : WholeNumber(bits) << shift;
  }
  int unit_ = 0;  // at most 0: `mapped` also needs 1 as an integer
};

Quotient toSegment(const P& p, const P& a, const P& b) {
  const P d = minus(b, a), w = minus(p, a);
  const WholeNumber along = dot(w, d), length = square(d);
  if (along <= 0) return {square(w)};
  if (along >= length) return {square(minus(p, b))};
  return {square(cross(w, d)), length};
}

Quotient toTriangle(const P& p, const std::array<P, 3>& t) {
  const Quotient sides =
      std::min({toSegment(p, t[0], t[1]), toSegment(p, t[1], t[2]), toSegment(p, t[2], t[0])});
  const P n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  const WholeNumber area = square(n);
  if (area == 0) return sides;
  for (int i = 0; i < 3; ++i)
    if (dot(cross(minus(t[(i + 1) % 3], t[i]), minus(p, t[i])), n) < 0) return sides;
  const WholeNumber height = dot(n, minus(p, t[0]));
  return std::min(sides, {height * height, area});
}

/// If the closest points of the edges p–p1 and q–q1 are inner points, returns the lesser of `best`
/// and the squared distance of the edges. Otherwise returns `best`: `toTriangle` handles the ends
/// of edges.
Quotient edges(const P& p, const P& p1, const P& q, const P& q1, const Quotient& best) {
  const P d = minus(p1, p), e = minus(q1, q), r = minus(q, p), n = cross(d, e);
  const WholeNumber area = square(n);
  if (area == 0) return best;
  // The closest points are p + s·d and q + t·e. Their difference r + t·e − s·d is parallel to n, so
  // s = (r × e)·n / n² and t = (r × d)·n / n².
  const WholeNumber s = dot(cross(r, e), n), t = dot(cross(r, d), n);
  if (s < 0 || s > area || t < 0 || t > area) return best;
  const WholeNumber height = dot(r, n);
  return std::min(best, {height * height, area});
}

}  // namespace

double referenceDistance(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB) {
  Grid grid;
  for (const Vec3& p : a) grid.cover(p);
  for (const Vec3& p : b) grid.cover(p);
  grid.cover(X_WA);
  grid.cover(X_WB);
  std::array<P, 3> s, t;
  for (int i = 0; i < 3; ++i) s[i] = grid.mapped(X_WA, a[i]), t[i] = grid.mapped(X_WB, b[i]);
  Quotient best = toTriangle(s[0], t);
  for (int i = 0; i < 3; ++i) {
    best = std::min({best, toTriangle(s[i], t), toTriangle(t[i], s)});
    for (int k = 0; k < 3; ++k) best = edges(s[i], s[(i + 1) % 3], t[k], t[(k + 1) % 3], best);
  }
  return grid.distance(best);
}

double referenceDistance(const Vec3& p_W, const Triangle& t, const Transform& X_WT) {
  Grid grid;
  grid.cover(p_W);
  for (const Vec3& p : t) grid.cover(p);
  grid.cover(X_WT);
  return grid.distance(
      toTriangle(grid.mapped({}, p_W),
                 {grid.mapped(X_WT, t[0]), grid.mapped(X_WT, t[1]), grid.mapped(X_WT, t[2])}));
}

}  // namespace corridor::test
