#pragma once

#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

/// Polynomials in Bernstein form on [0, 1], in plain double arithmetic. Nothing here bounds the
/// rounding.
namespace corridor::bernstein {

/// The polynomial Σ_i B_i(t)·c[i], where B_i are the Bernstein polynomials of degree `degree`.
struct Polynomial {
  static constexpr int kLargestDegree = 32;
  int degree = 0;
  std::array<double, kLargestDegree + 1> c{};

  double largest() const {  ///< max |c_i|, a bound of the absolute value on [0, 1]
    double most = 0;
    for (int i = 0; i <= degree; ++i) most = std::fmax(most, std::abs(c[i]));
    return most;
  }
};

/// Sets weights[i] = B_i(t) for i = 0 … degree, where B_i are the Bernstein polynomials.
inline void basis(int degree, double t, double* weights) {
  weights[0] = 1;
  for (int n = 1; n <= degree; ++n) {
    double carried = 0;
    for (int i = 0; i < n; ++i) {
      const double w = weights[i];
      weights[i] = carried + (1 - t) * w;
      carried = t * w;
    }
    weights[n] = carried;
  }
}

/// Returns the part of `p` on [from, to], as a polynomial on [0, 1] (de Casteljau, twice).
Polynomial restricted(Polynomial p, double from, double to);
/// Returns `p` written with the degree `degree`. @pre degree ≥ p.degree
Polynomial elevated(const Polynomial& p, int degree);
Polynomial product(const Polynomial& a, const Polynomial& b);
/// Computes outer(inner(t)) for several outer polynomials and one inner polynomial.
class Composition {
 public:
  /// @param degree the degree of the outer polynomials. @pre degree · inner.degree ≤
  /// kLargestDegree.
  Composition(const Polynomial& inner, int degree);
  Polynomial of(const Polynomial& outer) const;

 private:
  std::vector<Polynomial> basis_;  // the Bernstein polynomials of the outer degree, of inner(t)
};
/// Returns a − b.
Polynomial difference(const Polynomial& a, const Polynomial& b);

}  // namespace corridor::bernstein
