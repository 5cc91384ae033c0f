#pragma once

#include <array>
#include <span>

#include "planner/verify/triangle_gap.h"

namespace corridor::verify {

/// A polynomial on [0, 1]: Σ_i B_i(τ)·c[i], where B_i are the Bernstein polynomials of `degree`.
/// The values lie between the smallest and the largest coefficient; c[0] and c[degree] are the
/// values at 0 and 1.
///
/// `error` bounds how far each stored coefficient is from the real one. So it also bounds how far
/// each value of the stored polynomial is from the real value. `derivativeOf` and `halvesOf` add
/// their own rounding to `error`. They measure it: in x87 arithmetic the rounding error of a sum or
/// a product is itself a floating-point number, and is computed exactly (Knuth 1997, 4.2.2, theorem
/// B; std::fma). So `error` stays 0 as long as every result is exact.
struct Bernstein {
  static constexpr int kLargestDegree = 9;
  std::array<Real, kLargestDegree + 1> c{};
  int degree = 0;
  Real error = 0;

  Bernstein() = default;
  /// @param coefficients from 1 to kLargestDegree + 1 numbers, in order; they have no error.
  explicit Bernstein(std::span<const double> coefficients);

  std::span<const Real> coefficients() const { return {c.data(), std::size_t(degree) + 1}; }
  /// Returns an upper bound of the absolute values on [0, 1], `error` included.
  Real largest() const;
  /// Returns the value at τ in [0, 1], by de Casteljau's algorithm. @pre 1 − τ is exact.
  ///
  /// Rounding, with u = 2^-64: each of the `degree` levels multiplies once and adds once. So a
  /// value is off by at most f times the largest |c[i]|, plus `error`, where f = 2·degree·u·(1 +
  /// 2^-50) < 19u.
  Real at(Real tau) const;
};

/// Returns the derivative by τ, divided by `length`. If `length` is the duration of a piece, this
/// is the derivative by time. The derivative of a constant is 0.
/// @param length > 0.
/// @param lengthError bounds how far `length` is from the real length; at most 2^-20 of it.
Bernstein derivativeOf(const Bernstein& polynomial, Real length = 1, Real lengthError = 0);

/// Returns the polynomial on [0, 1/2] and on [1/2, 1], each as a function on [0, 1] (de Casteljau).
std::array<Bernstein, 2> halvesOf(const Bernstein& polynomial);

}  // namespace corridor::verify
