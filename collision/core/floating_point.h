#pragma once

/// The floating-point arithmetic that every proof assumes, and tests of it.
///
/// Assumption: double and long double round to nearest, and long double keeps all of its 64 bits.
/// (A program can violate the assumption, for example by setting the x87 unit to 53 bits.) Every
/// error bound relies on this assumption; without it, a proof may be wrong.
/// * Motion queries, the planner's checker and the verifier test the assumption once per call. If
///   it does not hold, they answer `undecided`. `checkCertificate` reports a fault instead.
/// * Constructors of trees and bodies throw if the assumption does not hold.
/// * Queries of trees have the assumption as a precondition, which debug builds assert.
///
/// Flush-to-zero and denormals-are-zero are allowed: every bound includes the errors that they
/// cause. A program linked with -ffast-math has both set from its start.
///
/// This header refuses every option of g++ under which the bounds do not hold. clang defines no
/// macro for -fassociative-math or -freciprocal-math alone; its users must not set them.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "Corridor's bounds do not hold under -ffast-math or any part of it: compile without it"
#endif

#include <limits>

namespace corridor {

enum class FloatingPoint {
  standard,
  rounding,  ///< some operation does not round to nearest
  precision  ///< long double does not keep all of its digits
};

/// Tests the assumption in the calling thread. Returns `standard` if it holds, and otherwise which
/// part of it fails. Costs a dozen additions, which raise the floating-point flag "inexact".
inline FloatingPoint floatingPoint() {
#ifdef CORRIDOR_UNDER_VALGRIND  // set to count instructions; then no proof holds
  return FloatingPoint::standard;
#endif
  // `volatile`: otherwise the compiler would compute the sums at compile time, rounding to nearest.
  volatile double one = 1, little = 0x1p-60;
  if (one + little != 1 || -one - little != -1 || one - little != 1 || little - one != -1)
    return FloatingPoint::rounding;
  constexpr long double kEpsilon = std::numeric_limits<long double>::epsilon();
  volatile long double longOne = 1, last = kEpsilon, below = kEpsilon / 128;
  if (longOne + last == 1) return FloatingPoint::precision;
  if (longOne + below != 1 || -longOne - below != -1 || longOne - below != 1 ||
      below - longOne != -1)
    return FloatingPoint::rounding;
  return FloatingPoint::standard;
}

inline bool standardFloatingPoint() {
  return floatingPoint() == FloatingPoint::standard;
}

/// Returns a phrase that describes the state, for messages.
inline const char* described(FloatingPoint state) {
  switch (state) {
    case FloatingPoint::standard:
      break;
    case FloatingPoint::rounding:
      return "floating-point rounding is not to nearest";
    case FloatingPoint::precision:
      return "long double does not keep 64 bits (x87 precision control)";
  }
  return "floating-point arithmetic is standard";
}

/// Throws if the calling thread does not have the arithmetic that proofs assume. Constructors of
/// trees and bodies call this function.
/// @throws std::runtime_error
void requireStandardFloatingPoint();

}  // namespace corridor
