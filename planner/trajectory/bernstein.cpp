#include "planner/trajectory/bernstein.h"

#include <algorithm>

namespace corridor::bernstein {
namespace {

using Row = std::array<double, Polynomial::kLargestDegree + 1>;

/// binomials[n][k]. All are below 2^53, so they are exact.
struct Binomials {
  std::array<Row, Polynomial::kLargestDegree + 1> of{};
  constexpr Binomials() {
    for (std::size_t n = 0; n < of.size(); ++n) {
      of[n][0] = 1;
      for (std::size_t k = 1; k <= n; ++k) of[n][k] = of[n - 1][k - 1] + (k < n ? of[n - 1][k] : 0);
    }
  }
};
constexpr Binomials kBinomials;

}  // namespace

Polynomial restricted(Polynomial p, double from, double to) {
  const int n = p.degree;
  if (to < 1)  // the part [0, to]
    for (int level = 1; level <= n; ++level)
      for (int i = n; i >= level; --i) p.c[i] = (1 - to) * p.c[i - 1] + to * p.c[i];
  if (from > 0) {  // the rest of it, from `from / to` on
    const double t = from / to;
    for (int level = 1; level <= n; ++level)
      for (int i = 0; i <= n - level; ++i) p.c[i] = (1 - t) * p.c[i] + t * p.c[i + 1];
  }
  return p;
}

Polynomial elevated(const Polynomial& p, int degree) {
  if (degree == p.degree) return p;
  Polynomial one;
  one.degree = degree - p.degree;
  std::fill_n(one.c.begin(), one.degree + 1, 1.0);
  return product(p, one);
}

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial result;
  result.degree = a.degree + b.degree;
  assert(result.degree <= Polynomial::kLargestDegree);
  const Row &ofA = kBinomials.of[a.degree], &ofB = kBinomials.of[b.degree];
  for (int i = 0; i <= a.degree; ++i) {
    const double scaled = ofA[i] * a.c[i];
    for (int k = 0; k <= b.degree; ++k) result.c[i + k] += scaled * (ofB[k] * b.c[k]);
  }
  const Row& of = kBinomials.of[result.degree];
  for (int i = 0; i <= result.degree; ++i) result.c[i] /= of[i];
  return result;
}

Polynomial composed(const Polynomial& outer, const Polynomial& inner) {
  // De Casteljau's algorithm on polynomials: b_i ← (1 − inner)·b_i + inner·b_{i+1}.
  Polynomial rest = inner;
  for (int i = 0; i <= rest.degree; ++i) rest.c[i] = 1 - rest.c[i];
  std::array<Polynomial, 10> b;
  assert(outer.degree < static_cast<int>(b.size()));
  for (int i = 0; i <= outer.degree; ++i) b[i].c[0] = outer.c[i];
  for (int level = 1; level <= outer.degree; ++level)
    for (int i = 0; i <= outer.degree - level; ++i) {
      b[i] = product(rest, b[i]);
      const Polynomial second = product(inner, b[i + 1]);
      for (int k = 0; k <= second.degree; ++k) b[i].c[k] += second.c[k];
    }
  return b[0];
}

Polynomial difference(const Polynomial& a, const Polynomial& b) {
  const int degree = std::max(a.degree, b.degree);
  Polynomial result = elevated(a, degree);
  const Polynomial other = elevated(b, degree);
  for (int i = 0; i <= degree; ++i) result.c[i] -= other.c[i];
  return result;
}

}  // namespace corridor::bernstein
