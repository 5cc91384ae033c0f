#include "collision/volumes/principal_axes.h"

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "collision/volumes/obb.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

class PrincipalAxes : public test::EveryTarget {};

Mat3 randomRotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

/// Compares with Eigen's eigenvalues: the spreads along the axes must be the eigenvalues, largest
/// first.
TEST_P(PrincipalAxes, DiagonaliseAndAreOrthonormal) {
  std::mt19937_64 random(test::testSeed(31));
  std::uniform_real_distribution<double> exponent(-20, 0), scale(-900, 900);
  for (int i = 0; i < 20'000; ++i) {
    const Mat3 R = randomRotation(random);
    Vec3 spread(1, std::exp2(exponent(random)), std::exp2(exponent(random)));
    if (i % 4 == 1) spread[1] = 1;
    if (i % 4 == 2) spread[2] = spread[1];
    const Mat3 c = R * spread.asDiagonal() * R.transpose();
    const Mat3 axes = principalAxes(c * std::exp2(std::floor(scale(random))));
    ASSERT_LT(orthonormalityDefect(axes), 0x1p-40) << i;
    ASSERT_GT(axes.determinant(), 0) << i;
    const Vec3 values = Eigen::SelfAdjointEigenSolver<Mat3>(c).eigenvalues();  // least first
    for (int j = 0; j < 3; ++j)
      ASSERT_NEAR(axes.col(j).dot(c * axes.col(j)), values[2 - j], 2e-6) << i << " " << j;
  }
}

/// If spreads are equal, noise must not rotate the axes: a cube's box must be the cube.
TEST_P(PrincipalAxes, AreTheCoordinateAxesIfSpreadsAreEqual) {
  std::mt19937_64 random(test::testSeed(32));
  std::uniform_real_distribution<double> noise(-1e-7, 1e-7);
  for (int i = 0; i < 300; ++i) {
    Vec3 spread = Vec3::Ones();
    if (i % 6 < 3) spread[i % 3] = i % 6 == 0 ? 0.01 : 3;
    Mat3 c = spread.asDiagonal();
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l <= k; ++l) c(k, l) = c(l, k) += noise(random);
    const Mat3 axes = principalAxes(c);
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(axes.col(j).cwiseAbs().maxCoeff(), 1, 1e-6) << i << "\n" << axes;
  }
}

TEST_P(PrincipalAxes, AreTheIdentityWithoutASpread) {
  constexpr double inf = std::numeric_limits<double>::infinity(),
                   nan = std::numeric_limits<double>::quiet_NaN();
  for (const double x : {0.0, 1.0, 1e-310, 1e308, inf, nan}) {
    EXPECT_EQ(principalAxes(Mat3::Identity() * x), Mat3::Identity()) << x;
    if (!(x > 0 && x < 1e308)) {
      EXPECT_EQ(principalAxes(Mat3::Constant(x)), Mat3::Identity()) << x;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Simd, PrincipalAxes, testing::ValuesIn(test::simdTargets()),
                         test::targetName);

}  // namespace
}  // namespace corridor
