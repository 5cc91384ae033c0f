#pragma once

#include "planner/verify/bernstein.h"

namespace corridor::verify {

/// The answer whether a polynomial stays within limits.
struct RangeAnswer {
  enum class Verdict {
    /// The real polynomial is within [lower, upper] for every τ in [0, 1]. Never wrong.
    within,
    /// The real polynomial is beyond a limit at τ = `at`. Never wrong.
    exceeded,
    /// The polynomial was not shown to exceed a limit, but near τ = `at` it is so close to a limit
    /// that rounding, or the polynomial's own `error`, decides. Or a coefficient is not finite, or
    /// a
    /// limit is NaN.
    undecided,
  };
  Verdict verdict = Verdict::within;
  Real at = 0;     ///< τ; exceeded or undecided only
  Real value = 0;  ///< the value there, rounded
};

/// Decides whether a polynomial stays within [lower, upper] on [0, 1]. Both limits are inclusive,
/// and may be infinite. To test a limit of positions, pass a piece's coefficients. To test a limit
/// of velocities or accelerations, pass the result of derivativeOf() with the piece's duration,
/// applied once or twice.
///
/// Method (Lane, Riesenfeld 1980): the polynomial is within its coefficients' range. If this range
/// is not within the limits, and no end of the interval is beyond them, the interval is halved. The
/// distance of the coefficients from the polynomial decreases with the square of the interval's
/// width. So only intervals around a time at which the polynomial touches a limit are halved often.
/// Halving ends where no coefficient is beyond the limit by more than Bernstein::error. In such an
/// interval, no value can be shown to exceed the limit.
///
/// A piece that starts or ends exactly on a limit, and turns inwards there, is usually decided: the
/// first and the last coefficient are the exact values at the ends. If sums of coefficients are
/// rounded, `undecided` is possible at such an end, too.
/// @pre lower ≤ upper, unless one of them is NaN.
RangeAnswer rangeOf(const Bernstein& polynomial, Real lower, Real upper);

}  // namespace corridor::verify
