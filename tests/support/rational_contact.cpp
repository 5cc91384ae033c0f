#include "tests/support/rational_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include <boost/multiprecision/cpp_int.hpp>

namespace corridor::test {
namespace {

/// An integer of any length; up to 512 bits without allocation.
using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked,
                                           std::allocator<boost::multiprecision::limb_type>>,
    boost::multiprecision::et_off>;

/// A double or a product of two doubles: digits · 2^exponent.
struct Term {
  Integer digits;
  int exponent = std::numeric_limits<int>::max();  // the exponent of 0
};
Term term(double x, double y = 1) {
  if (x == 0 || y == 0) return {};
  int ex = 0, ey = 0;
  const double mx = std::frexp(x, &ex), my = std::frexp(y, &ey);
  return {Integer(static_cast<std::int64_t>(std::ldexp(mx, 53))) *
              static_cast<std::int64_t>(std::ldexp(my, 53)),
          ex + ey - 106};
}

constexpr std::size_t kRows = 5, kColumns = 6;
using Row = std::array<Integer, kColumns + 1>;  // the right side last

/// Returns whether there is an x ≥ 0 with M x = r, for r ≥ 0. Phase one of the simplex method with
/// Bland's rule, by integer pivoting (Edmonds). The tableau is T/D, and the entries of T are minors
/// of [M | r], so all divisions are exact. Bland's rule guarantees that the algorithm ends.
bool feasible(std::array<Row, kRows>& T) {
  Integer D = 1;
  std::array<std::size_t, kRows> basis;
  for (std::size_t i = 0; i < kRows; ++i)
    basis[i] = kColumns + i;  // artificial variables, of cost 1
  for (;;) {
    // Reduced cost of column j: −Σ over rows whose basic variable is artificial.
    std::size_t enter = kColumns;
    for (std::size_t j = 0; j < kColumns && enter == kColumns; ++j) {
      Integer gain = 0;
      for (std::size_t i = 0; i < kRows; ++i)
        if (basis[i] >= kColumns) gain += T[i][j];
      if (gain > 0) enter = j;
    }
    if (enter == kColumns) break;
    std::size_t leave = kRows;
    for (std::size_t i = 0; i < kRows; ++i) {
      if (T[i][enter] <= 0) continue;
      if (leave == kRows) {
        leave = i;
        continue;
      }
      const Integer here = T[i][kColumns] * T[leave][enter],
                    best = T[leave][kColumns] * T[i][enter];
      if (here < best || (here == best && basis[i] < basis[leave])) leave = i;
    }
    if (leave == kRows) break;  // can't happen: the sum of artificial variables is bounded below
    const Integer pivot = T[leave][enter];
    for (std::size_t i = 0; i < kRows; ++i) {
      if (i == leave) continue;
      const Integer factor = T[i][enter];
      for (std::size_t j = 0; j <= kColumns; ++j) {
        T[i][j] *= pivot;
        if (factor != 0) T[i][j] -= factor * T[leave][j];
        if (D != 1) T[i][j] /= D;
      }
    }
    D = pivot;
    basis[leave] = enter;
  }
  for (std::size_t i = 0; i < kRows; ++i)
    if (basis[i] >= kColumns && T[i][kColumns] != 0) return false;
  return true;
}

}  // namespace

bool rationalContact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                     const Transform& X_WB) {
  // The system: Σ λ_i a_i − Σ μ_j b_j = 0, Σ λ = Σ μ = 1, λ, μ ≥ 0. Each coordinate is in units of
  // its own power of two.
  std::array<Row, kRows> T;
  for (int k = 0; k < 3; ++k) {
    std::array<std::array<Term, 4>, kColumns> terms;
    int least = std::numeric_limits<int>::max();
    for (int i = 0; i < 6; ++i) {
      const Vec3& p = i < 3 ? a[i] : b[i - 3];
      const Transform& X = i < 3 ? X_WA : X_WB;
      terms[i] = {term(X.t[k]), term(X.m(k, 0), p[0]), term(X.m(k, 1), p[1]),
                  term(X.m(k, 2), p[2])};
      for (const Term& t : terms[i]) least = std::min(least, t.exponent);
    }
    for (int i = 0; i < 6; ++i) {
      Integer& x = T[k][i] = 0;
      for (const Term& t : terms[i])
        if (t.digits != 0) x += t.digits << (t.exponent - least);
      if (i >= 3) x = -x;
    }
    T[k][kColumns] = 0;
  }
  for (int i = 0; i < 6; ++i) {
    T[3][i] = i < 3;
    T[4][i] = i >= 3;
  }
  T[3][kColumns] = T[4][kColumns] = 1;
  return feasible(T);
}

}  // namespace corridor::test
