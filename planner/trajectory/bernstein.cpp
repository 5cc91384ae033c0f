#include "planner/trajectory/bernstein.h"

#include <algorithm>

namespace corridor::bernstein {
namespace {

using Row = std::array<double, Polynomial::kLargestDegree + 1>;

/// The binomial coefficients: of[n][k] is the number of subsets of k elements of a set of n
/// elements. All are below 2^53, so they are exact.
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
  if (from > 0) {  // p is now the part [0, to]; keep its part [from/to, 1]
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

Composition::Composition(const Polynomial& inner, int degree) {
  Polynomial rest = inner, one;
  for (int i = 0; i <= rest.degree; ++i) rest.c[i] = 1 - rest.c[i];
  one.c[0] = 1;
  // basis_[i] = C(degree, i) · inner^i · rest^(degree − i), with rest = 1 − inner
  basis_.push_back(one);
  for (int i = 1; i <= degree; ++i) basis_.push_back(product(basis_.back(), inner));
  Polynomial power = one;
  for (int i = degree; i >= 0; --i) {
    basis_[i] = product(basis_[i], power);
    for (int k = 0; k <= basis_[i].degree; ++k) basis_[i].c[k] *= kBinomials.of[degree][i];
    if (i > 0) power = product(power, rest);
  }
}

Polynomial Composition::of(const Polynomial& outer) const {
  assert(outer.degree + 1 == static_cast<int>(basis_.size()));
  Polynomial result;
  result.degree = basis_.front().degree;
  for (int i = 0; i <= outer.degree; ++i)
    for (int k = 0; k <= result.degree; ++k) result.c[k] += outer.c[i] * basis_[i].c[k];
  return result;
}

Polynomial difference(const Polynomial& a, const Polynomial& b) {
  const int degree = std::max(a.degree, b.degree);
  Polynomial result = elevated(a, degree);
  const Polynomial other = elevated(b, degree);
  for (int i = 0; i <= degree; ++i) result.c[i] -= other.c[i];
  return result;
}

}  // namespace corridor::bernstein
