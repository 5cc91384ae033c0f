#include "planner/verify/polynomial_range.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace corridor::verify {
namespace {

/// The largest depth; τ then has 60 bits. In an interval of width 2^-60, the coefficients differ
/// from the polynomial's values by 2^-120 of the second derivative. This is far less than one
/// rounding of the coefficients.
constexpr int kDepth = 60;
/// The maximum number of halvings; a part that would need more is undecided. A polynomial of degree
/// 9 touches its limits at 10 times at most. Around each of these times there are two intervals of
/// each length. Only a polynomial that stays within rounding of a limit over a whole interval needs
/// more halvings.
constexpr int kMostHalvings = 4000;

struct Part {
  Bernstein polynomial;
  Real start = 0;  ///< start of the part's interval
  int depth = 0;   ///< the part's interval has width 2^-depth
};

}  // namespace

RangeAnswer rangeOf(const Bernstein& polynomial, Real lower, Real upper) {
  RangeAnswer answer;
  /// Returns by how much a value is beyond the limits; negative inside.
  const auto beyond = [&](Real value) { return std::max(value - upper, lower - value); };
  // A difference is rounded once, so its sign is right. Where the difference is compared with
  // `error`, a factor covers this rounding.
  constexpr Real up = 1 + 0x1p-50L, down = 1 - 0x1p-50L;
  const auto record = [&](RangeAnswer::Verdict verdict, Real at, Real value) {
    answer = {verdict, at, value};
  };
  // A maximum of several numbers may drop a NaN.
  const auto coefficients = polynomial.coefficients();
  if (std::isnan(lower) || std::isnan(upper) || !std::isfinite(polynomial.error) ||
      !std::all_of(coefficients.begin(), coefficients.end(),
                   [](Real c) { return std::isfinite(c); })) {
    record(RangeAnswer::Verdict::undecided, 0, polynomial.c[0]);
    return answer;
  }
  int halvings = 0;
  std::vector<Part> open = {{polynomial, 0, 0}};
  while (!open.empty()) {
    const Part part = open.back();
    open.pop_back();
    const Bernstein& p = part.polynomial;
    const Real width = std::ldexp(Real(1), -part.depth), error = p.error;
    Real most = -std::numeric_limits<Real>::infinity();
    for (const Real each : p.coefficients()) most = std::max(most, beyond(each));
    if (most <= 0 && -most * down >= error) continue;
    for (const bool last : {false, true}) {
      const Real value = p.c[last ? std::size_t(p.degree) : 0];
      if (beyond(value) * down <= error) continue;
      record(RangeAnswer::Verdict::exceeded, part.start + (last ? width : 0), value);
      return answer;
    }
    if (most <= error * up || part.depth == kDepth || ++halvings > kMostHalvings) {
      if (answer.verdict == RangeAnswer::Verdict::within)
        record(RangeAnswer::Verdict::undecided, part.start, p.c[0]);
      continue;
    }
    const std::array<Bernstein, 2> halves = halvesOf(p);
    open.push_back({halves[1], part.start + width / 2, part.depth + 1});
    open.push_back({halves[0], part.start, part.depth + 1});
  }
  return answer;
}

}  // namespace corridor::verify
