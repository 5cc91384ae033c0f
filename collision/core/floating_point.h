#pragma once

/// What every proof assumes of the processor and of the compiler.
///
/// Rounding is to nearest, in double and in long double, and long double keeps all of its digits
/// (the x87 of a program can be set to 53 bits). Every bound counts roundings under that
/// assumption: in another mode a proof may be wrong. Motion queries, the check of certificates, the
/// planner's checker and the verifier test it once a call (`standardFloatingPoint`) and answer
/// `undecided` where it does not hold. Trees and bodies refuse to be built there. Queries of trees
/// have it as a precondition, which they assert in debug builds.
///
/// Flush-to-zero and denormals-are-zero are allowed: every bound has room for what they lose. A
/// program that is linked with -ffast-math has both set from its start.
///
/// The headers refuse every option of g++ under which no bound holds. clang defines no macro for
/// -fassociative-math and -freciprocal-math alone: there it is the caller's to leave them out.
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

/// How the processor computes in this thread. A dozen additions; they raise the flag "inexact".
inline FloatingPoint floatingPoint() {
  // `volatile` keeps the compiler from computing these itself, which it would do to nearest.
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

/// What is wrong, for messages.
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

/// For constructors of what proofs rest on. @throws std::runtime_error
void requireStandardFloatingPoint();

}  // namespace corridor
