#include "planner/verify/bernstein.h"

#include <algorithm>
#include <cmath>

namespace corridor::verify {
namespace {

/// A rounded result, and the absolute value of its rounding.
struct Rounded {
  Real value, rounding;
};

Rounded sumOf(Real a, Real b) {
  const Real sum = a + b, ofB = sum - a, ofA = sum - ofB;
  return {sum, std::abs((a - ofA) + (b - ofB))};
}

}  // namespace

Bernstein::Bernstein(std::span<const double> coefficients)
    : degree(static_cast<int>(coefficients.size()) - 1) {
  std::copy(coefficients.begin(), coefficients.end(), c.begin());
}

Real Bernstein::largest() const {
  Real most = 0;
  for (const Real each : coefficients()) most = std::max(most, std::abs(each));
  return error > 0 ? (most + error) * kUp : most;
}

Real Bernstein::at(Real tau) const {
  std::array<Real, kLargestDegree + 1> level = c;
  for (int left = degree; left > 0; --left)
    for (std::size_t i = 0; i < std::size_t(left); ++i)
      level[i] = (1 - tau) * level[i] + tau * level[i + 1];
  return level[0];
}

Bernstein derivativeOf(const Bernstein& polynomial, Real length, Real lengthError) {
  Bernstein derivative;
  if (polynomial.degree == 0) return derivative;
  derivative.degree = polynomial.degree - 1;
  const Real n = polynomial.degree;
  const Real perLength = lengthError > 0 ? (1 + 0x1p-19L) : kUp;  // ≥ length / L
  for (std::size_t i = 0; i <= std::size_t(derivative.degree); ++i) {
    const Rounded step = sumOf(polynomial.c[i + 1], -polynomial.c[i]);
    const Real product = n * step.value, result = product / length;
    // Let n be the degree, d the real difference and L the real length. The real result is n·d / L,
    // and n·d − result·L = (n·d − product) + (product − result·length) + result·(length − L). In
    // the first term, n times the rounding of the difference is bounded by `ofDifference`. std::fma
    // computes the rest of this term, and the second term, exactly.
    const Real ofDifference = n * (step.rounding + 2 * polynomial.error),
               ofProduct = std::abs(std::fma(n, step.value, -product)),
               ofQuotient = std::abs(std::fma(-result, length, product)),
               ofLength = std::abs(result) * lengthError;
    const Real error = (ofDifference + ofProduct + ofQuotient + ofLength) / length * perLength;
    derivative.c[i] = result;
    derivative.error = std::max(derivative.error, error);
  }
  return derivative;
}

std::array<Bernstein, 2> halvesOf(const Bernstein& polynomial) {
  std::array<Bernstein, 2> halves = {polynomial, polynomial};
  const auto n = static_cast<std::size_t>(polynomial.degree);
  std::array<Real, Bernstein::kLargestDegree + 1>& level = halves[1].c;
  Real error = polynomial.error;
  for (std::size_t k = 1; k <= n; ++k) {
    // After k levels of de Casteljau's algorithm, level[i] for i ≤ n − k is the average of level k
    // that begins at coefficient i. The entries after these are already coefficients of the right
    // half.
    Real most = 0;
    for (std::size_t i = 0; i + k <= n; ++i) {
      const Rounded sum = sumOf(level[i], level[i + 1]);
      level[i] = sum.value / 2;  // exact
      most = std::max(most, sum.rounding / 2);
    }
    halves[0].c[k] = level[0];
    if (most > 0) error = (error + most) * kUp;
  }
  halves[0].error = halves[1].error = error;
  return halves;
}

}  // namespace corridor::verify
