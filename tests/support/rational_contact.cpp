#include "tests/support/rational_contact.h"

#include <array>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

namespace corridor::test {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Point = std::array<Rational, 3>;

Point mapped(const Transform& X, const Vec3& p) {
  Point q;
  for (int i = 0; i < 3; ++i) {
    q[i] = Rational(X.t[i]);
    for (int k = 0; k < 3; ++k) q[i] += Rational(X.m(i, k)) * Rational(p[k]);
  }
  return q;
}

/// Is there x ≥ 0 with M x = r? Phase one of the simplex method with Bland's rule, in rationals:
/// always ends, never errs.
bool feasible(std::vector<std::vector<Rational>> M, std::vector<Rational> r) {
  const std::size_t rows = M.size(), columns = M[0].size();
  for (std::size_t i = 0; i < rows; ++i)
    if (r[i] < 0) {
      r[i] = -r[i];
      for (Rational& x : M[i]) x = -x;
    }
  std::vector<std::size_t> basis(rows);
  for (std::size_t i = 0; i < rows; ++i) basis[i] = columns + i;  // artificial variables, cost 1
  for (;;) {
    // Reduced cost of column j: −Σ over rows whose basic variable is artificial.
    std::size_t enter = columns;
    for (std::size_t j = 0; j < columns && enter == columns; ++j) {
      Rational cost = 0;
      for (std::size_t i = 0; i < rows; ++i)
        if (basis[i] >= columns) cost -= M[i][j];
      if (cost < 0) enter = j;
    }
    if (enter == columns) break;
    std::size_t leave = rows;
    for (std::size_t i = 0; i < rows; ++i) {
      if (M[i][enter] <= 0) continue;
      if (leave == rows) {
        leave = i;
        continue;
      }
      const Rational here = r[i] / M[i][enter], best = r[leave] / M[leave][enter];
      if (here < best || (here == best && basis[i] < basis[leave])) leave = i;
    }
    if (leave == rows) break;  // cannot be: the sum of artificials is bounded below
    const Rational pivot = M[leave][enter];
    for (Rational& x : M[leave]) x /= pivot;
    r[leave] /= pivot;
    for (std::size_t i = 0; i < rows; ++i) {
      if (i == leave || M[i][enter] == 0) continue;
      const Rational factor = M[i][enter];
      for (std::size_t j = 0; j < columns; ++j) M[i][j] -= factor * M[leave][j];
      r[i] -= factor * r[leave];
    }
    basis[leave] = enter;
  }
  for (std::size_t i = 0; i < rows; ++i)
    if (basis[i] >= columns && r[i] != 0) return false;
  return true;
}

}  // namespace

bool rationalContact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                     const Transform& X_WB) {
  // Σ λ_i a_i − Σ μ_j b_j = 0, Σ λ = Σ μ = 1, λ, μ ≥ 0.
  std::vector<std::vector<Rational>> M(5, std::vector<Rational>(6));
  for (int i = 0; i < 3; ++i) {
    const Point p = mapped(X_WA, a[i]), q = mapped(X_WB, b[i]);
    for (int k = 0; k < 3; ++k) {
      M[k][i] = p[k];
      M[k][3 + i] = -q[k];
    }
    M[3][i] = 1;
    M[4][3 + i] = 1;
  }
  return feasible(M, {0, 0, 0, 1, 1});
}

}  // namespace corridor::test
