#include "collision/core/rigid_pose.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

using Quaternion = Eigen::Quaternion<long double>;

/// The matrices of all 24 rotations that take axes to axes must be exact, from quaternions with
/// coefficients as they occur in files.
TEST(RotationMatrix, IsExactForQuarterTurns) {
  int rotations = 0;
  for (const double half : {0.7071067811865476, 0.7071068, 3.0})
    for (int code = 0; code < 81; ++code) {
      Eigen::Vector4d q;
      int rest = code, nonzero = 0;
      for (int k = 0; k < 4; ++k, rest /= 3) {
        q[k] = half * (rest % 3 - 1);
        nonzero += q[k] != 0;
      }
      if (nonzero == 0 || nonzero == 3) continue;
      const Mat3 m = rotationMatrix(Eigen::Quaterniond(q));
      EXPECT_EQ(m.cwiseAbs().sum(), 3) << q.transpose();
      EXPECT_EQ(m * m.transpose(), Mat3::Identity()) << q.transpose();
      EXPECT_EQ(m.determinant(), 1) << q.transpose();
      EXPECT_EQ(m, Eigen::Quaterniond(q).normalized().toRotationMatrix().array().round().matrix());
      ++rotations;
    }
  EXPECT_EQ(rotations, 3 * 48);  // q and -q
}

TEST(RotationMatrix, IsThatOfLongDoublesUpToRounding) {
  std::mt19937_64 random(test::testSeed(5));
  std::normal_distribution<double> normal;
  for (int n = 0; n < 10'000; ++n) {
    const double size = std::pow(10.0, normal(random));
    const Eigen::Quaterniond q(size * normal(random), size * normal(random), size * normal(random),
                               size * normal(random));
    const auto exact = rotationMatrix(Quaternion(q.cast<long double>()));
    EXPECT_LT((exact.cast<double>() - rotationMatrix(q)).cwiseAbs().maxCoeff(), 8 * 0x1p-53);
    const auto square = exact * exact.transpose();
    EXPECT_LT((square - decltype(exact)::Identity()).cwiseAbs().maxCoeff(), 2e-18L);
    const auto turned =
        Quaternion(q.cast<long double>()).normalized() * Eigen::Matrix<long double, 3, 1>(1, 2, 3);
    EXPECT_LT((exact * Eigen::Matrix<long double, 3, 1>(1, 2, 3) - turned).norm(), 1e-17L);
  }
}

}  // namespace
}  // namespace corridor
