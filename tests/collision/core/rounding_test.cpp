// Tests of the compiler's properties that every bound on rounding assumes, and of the guarantees of
// rounding.h.
#include "collision/core/rounding.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

#if defined(__GNUC__)
#define CORRIDOR_APART __attribute__((noinline))
#else
#define CORRIDOR_APART
#endif

/// Rounds two doubles to float. g++ 12 vectorised this function at -O2, and the compiled code did
/// not round. The build therefore uses -fno-tree-vectorize.
CORRIDOR_APART void throughFloat(const double* from, double* to) {
  const float x = static_cast<float>(from[0]), y = static_cast<float>(from[1]);
  to[0] = x;
  to[1] = y;
}

/// Rounds squares to float, in a loop, and keeps them as float and as double.
CORRIDOR_APART void throughFloats(const double* from, double* to, float* kept, int count) {
  for (int i = 0; i < count; ++i) {
    kept[i] = static_cast<float>(from[i] * from[i]);
    to[i] = kept[i];
  }
}

/// Returns a·b + c. There are two roundings if the compiler does not use a fused multiply-add.
CORRIDOR_APART double multiplyAdd(double a, double b, double c) {
  return a * b + c;
}

TEST(Compiler, RoundsToFloat) {
  volatile double third = 1.0 / 3;  // volatile: the compiler must not round at compile time
  const double from[4] = {third, third / 5, third / 7, third / 11};
  double to[4];
  float kept[4];
  throughFloat(from, to);
  for (int i = 0; i < 2; ++i) {
    volatile float rounded = static_cast<float>(from[i]);
    EXPECT_NE(to[i], from[i]);
    EXPECT_EQ(to[i], rounded);
  }
  throughFloats(from, to, kept, 4);
  for (int i = 0; i < 4; ++i) {
    volatile float rounded = static_cast<float>(from[i] * from[i]);
    EXPECT_NE(to[i], from[i] * from[i]);
    EXPECT_EQ(to[i], rounded);
    EXPECT_EQ(kept[i], rounded);
  }
}

TEST(Compiler, RoundsEveryProduct) {
  volatile double x = 1 + 0x1p-30;
  EXPECT_EQ(multiplyAdd(x, x, -(x * x)), 0);
}

TEST(Rounding, BoundsAreNeverExceeded) {
  std::mt19937_64 random(test::testSeed(3));
  for (int n = 0; n < 10'000; ++n) {
    const double x = std::exp2(std::uniform_real_distribution(-1074.0, 1023.0)(random));
    // The worst case: sixteen roundings, all in the wrong direction.
    double low = x, high = x;
    for (int i = 0; i < 16; ++i) {
      low = std::nextafter(low, 0);
      high = std::nextafter(high, HUGE_VAL);
    }
    EXPECT_GE(roundedUp(low), x);
    EXPECT_LE(roundedDown(high), x);
    EXPECT_LE(powerOfTwo(x), std::max(x, 0x1p-1000));
    EXPECT_GT(2 * powerOfTwo(x), std::min(x, 0x1p1000));
    EXPECT_LE(rootOrZero(x) * rootOrZero(x), x * (1 + 4 * kUnit));
  }
  EXPECT_TRUE(std::isnan(roundedUp(std::nan(""))));
}

/// The sum of two doubles, and its error, are exact in long double here: both have digits within 64
/// bits of the larger one.
TEST(Rounding, SumsThatAreExactStayAsTheyAre) {
  std::mt19937_64 random(test::testSeed(4));
  int exact = 0;
  for (int n = 0; n < 20'000; ++n) {
    const double a = std::uniform_real_distribution(0.5, 1.0)(random);
    double b = std::ldexp(std::uniform_real_distribution(0.5, 1.0)(random), -int(n % 10));
    if (n % 3 == 0) b = std::ldexp(std::floor(std::ldexp(b, 40)), -40);
    if (n % 2) b = -std::min(a, b);
    const long double sum = static_cast<long double>(a) + b;
    const bool isExact = static_cast<double>(sum) == sum;
    exact += isExact;
    EXPECT_GE(sumRoundedUp(a, b), sum);
    EXPECT_EQ(sumRoundedUp(a, b) == a + b, isExact) << a << " " << b;
    EXPECT_EQ(sumRoundedUp(a, b), sumRoundedUp(b, a));
  }
  EXPECT_GT(exact, 2000);
  EXPECT_LT(exact, 18'000);
  EXPECT_EQ(sumRoundedUp(0, 0.3), 0.3);
  EXPECT_TRUE(std::isnan(sumRoundedUp(std::nan(""), 1)));
  EXPECT_EQ(sumRoundedUp(HUGE_VAL, 1), HUGE_VAL);
}

}  // namespace
}  // namespace corridor
