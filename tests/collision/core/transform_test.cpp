// Tests of maps: their sums are spelled out, and equal those of Eigen's expressions bit for bit.
#include "collision/core/transform.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

Transform randomMap(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> power(-30, 30);
  Transform X;
  for (double& x : X.m.reshaped()) x = std::ldexp(normal(random), power(random));
  for (double& x : X.t) x = std::ldexp(normal(random), power(random));
  return X;
}

TEST(Transform, EqualsEigensExpressions) {
#if !defined(EIGEN_VECTORIZE_SSE2) || defined(EIGEN_VECTORIZE_FMA)
  GTEST_SKIP() << "Eigen adds in another order without SSE2, and rounds less often with FMA";
#endif
  std::mt19937_64 random(test::testSeed(7));
  for (int i = 0; i < 20'000; ++i) {
    const Transform a = randomMap(random), b = randomMap(random);
    const Transform both = a * b, inverse = rigidInverse(a);
    EXPECT_EQ(a * b.t, Vec3(a.m * b.t + a.t));
    EXPECT_EQ(both.m, Mat3(a.m * b.m));
    EXPECT_EQ(both.t, Vec3(a.m * b.t + a.t));
    EXPECT_EQ(inverse.m, Mat3(a.m.transpose()));
    EXPECT_EQ(inverse.t, Vec3(-(a.m.transpose() * a.t)));
  }
}

TEST(Transform, EveryNumberCounts) {
  std::mt19937_64 random(test::testSeed(8));
  const Transform X = randomMap(random);
  EXPECT_TRUE(X == X);
  EXPECT_TRUE(X.isFinite());
  for (int i = 0; i < 12; ++i) {
    Transform other = X, infinite = X;
    double& number = i < 9 ? other.m.data()[i] : other.t.data()[i - 9];
    number = std::nextafter(number, 1e300);
    EXPECT_FALSE(X == other) << i;
    (i < 9 ? infinite.m.data()[i] : infinite.t.data()[i - 9]) =
        i % 2 ? std::numeric_limits<double>::quiet_NaN() : std::numeric_limits<double>::infinity();
    EXPECT_FALSE(infinite.isFinite()) << i;
    EXPECT_EQ(infinite == infinite, i % 2 == 0) << "NaN does not equal itself " << i;
  }
}

}  // namespace
}  // namespace corridor
