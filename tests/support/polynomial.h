#pragma once

#include <optional>
#include <vector>

#include "tests/support/integer.h"

/// Exact real roots of polynomials, for oracles: Sturm sequences over the integers.
namespace corridor::test {

/// A polynomial Σ c_i x^i with integer coefficients.
class Polynomial {
 public:
  Polynomial() = default;  ///< zero
  /// @param coefficients  from the constant term up.
  explicit Polynomial(std::vector<Integer> coefficients);

  bool isZero() const { return c_.empty(); }
  int degree() const { return static_cast<int>(c_.size()) - 1; }  ///< −1 for zero
  const std::vector<Integer>& coefficients() const { return c_; }
  /// Returns the sign of the polynomial at n/2^k.
  int signAt(const Integer& n, unsigned k) const;
  /// Returns 2^(k·degree) times the polynomial's value at n/2^k.
  Integer scaledValue(const Integer& n, unsigned k) const;
  Polynomial derivative() const;
  /// Returns the polynomial divided by the greatest common divisor of its coefficients.
  Polynomial primitive() const;

  friend Polynomial operator+(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator-(const Polynomial& a, const Polynomial& b);
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b);
  friend bool operator==(const Polynomial& a, const Polynomial& b) { return a.c_ == b.c_; }

 private:
  std::vector<Integer> c_;  // the last coefficient is not 0; empty for zero
};

/// Returns the remainder of a divided by b, times the positive factor that makes the remainder
/// primitive.
/// @pre b is not zero.
Polynomial remainder(const Polynomial& a, const Polynomial& b);
/// Returns a/b, or nullopt if b does not divide a. @pre b is primitive and not zero.
std::optional<Polynomial> quotient(Polynomial a, const Polynomial& b);
/// Returns the greatest common divisor: primitive, of either sign.
Polynomial greatestCommonDivisor(Polynomial a, Polynomial b);

/// A real root in (0, 1]: the only root of a square-free polynomial in (n, n + 1]/2^k.
class Root {
 public:
  /// @pre p is square-free and has exactly one root in (n, n + 1]/2^k.
  Root(Polynomial p, Integer n, unsigned k) : p_(std::move(p)), n_(std::move(n)), k_(k) {}

  const Integer& n() const { return n_; }
  unsigned k() const { return k_; }
  /// Returns the exact sign of g at the root. May narrow the interval of the root.
  int signOf(const Polynomial& g);
  /// Halves the interval until `k()` is at least `k`.
  void narrow(unsigned k);

 private:
  void halve();

  Polynomial p_;
  Integer n_;
  unsigned k_;
};

/// Returns all distinct roots in (0, 1], ascending. @pre p is not zero.
std::vector<Root> rootsInUnitInterval(const Polynomial& p);

}  // namespace corridor::test
