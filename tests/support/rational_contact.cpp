#include "tests/support/rational_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tests/support/rational_program.h"

namespace corridor::test {
namespace {

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

constexpr int kCorners = 6;

}  // namespace

bool rationalContact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                     const Transform& X_WB) {
  // The system for the corners a_i and b_j is Σ λ_i a_i − Σ μ_j b_j = 0, Σ λ_i = Σ μ_j = 1, with
  // all λ_i ≥ 0 and all μ_j ≥ 0. Each coordinate is in units of its own power of two.
  IntegerSystem T(5, std::vector<Integer>(kCorners + 1));
  for (int k = 0; k < 3; ++k) {
    std::array<std::array<Term, 4>, kCorners> terms;
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
    T[k][kCorners] = 0;
  }
  for (int i = 0; i < 6; ++i) {
    T[3][i] = i < 3;
    T[4][i] = i >= 3;
  }
  T[3][kCorners] = T[4][kCorners] = 1;
  return hasSolution(std::move(T));
}

}  // namespace corridor::test
