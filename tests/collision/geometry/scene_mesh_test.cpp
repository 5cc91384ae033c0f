// The bound of the rounding of transforms, against products in more digits.
#include "collision/geometry/scene_mesh.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor::test {
namespace {

using Wide = Eigen::Transform<long double, 3, Eigen::Affine>;

Eigen::Affine3d randomStep(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  Eigen::Affine3d step = Eigen::Affine3d::Identity();
  switch (random() % 3) {
    case 0:
      step.translation() = vector() * std::exp(8 * normal(random));
      break;
    case 1:
      step.linear() = Eigen::AngleAxisd(normal(random), vector().normalized()).toRotationMatrix();
      break;
    default:
      step.linear() = vector().asDiagonal();
      step.linear() *= std::exp(normal(random));
  }
  return step;
}

TEST(NodePath, RoundingIsABound) {
  std::mt19937_64 random(testSeed(3));
  double most = 0;
  for (int i = 0; i < 20'000; ++i) {
    NodePath path;
    Wide exact = Wide::Identity();
    for (int steps = 1 + static_cast<int>(random() % 12); steps > 0; --steps) {
      const Eigen::Affine3d step = randomStep(random);
      path = path.below(step);
      exact = exact * step.cast<long double>();
    }
    const Vec3 point = randomStep(random).linear() * Vec3(1, -20, 300);
    const double error = static_cast<double>(
        ((path.map() * point).cast<long double>() - exact * point.cast<long double>()).norm());
    const double bound = path.rounding(point.norm());
    ASSERT_LE(error, bound) << "path " << i;
    most = std::max(most, error / bound);
  }
  EXPECT_GT(most, 1e-4) << "the bound is of no use";
}

TEST(NodePath, StretchesOfParentsEnlargeTranslations) {
  Eigen::Affine3d large = Eigen::Affine3d::Identity(), far = large;
  large.linear() *= 1e6;
  far.translation().x() = 1e9;
  EXPECT_GT(NodePath().below(large).below(far).rounding(0), 1e15 * 0x1p-53);
  EXPECT_LT(NodePath().below(far).below(large).rounding(0), 1e15 * 0x1p-53);
}

TEST(NodePath, TransformsThatVanish) {
  Eigen::Affine3d small = Eigen::Affine3d::Identity();
  small.linear() *= 1e-130;
  const NodePath once = NodePath().below(small), twice = once.below(small);
  EXPECT_LT(once.rounding(1), HUGE_VAL);
  EXPECT_EQ(twice.rounding(1), HUGE_VAL);
}

TEST(NodePath, MirrorsOfAnySize) {
  const auto isMirrored = [](double x, double y, double z) {
    return NodePath().below(Eigen::Affine3d(Eigen::Scaling(x, y, z))).isMirrored();
  };
  for (const double s : {1e-249, 1e-170, 1e-5, 1.0, 1e170, 1e249}) {
    EXPECT_TRUE(isMirrored(1, s, -s)) << s;
    EXPECT_FALSE(isMirrored(1, -s, -s)) << s;
  }
}

/// An entry of the product on the way is subnormal, and the later ones make it large again.
TEST(NodePath, EntriesThatLoseDigitsOnTheWay) {
  NodePath path;
  const auto scale = [&](double x, double y) {
    path = path.below(Eigen::Affine3d(Eigen::Scaling(x, y, 1.0)));
  };
  for (const double x : {1e-160, 1.3e-163, 1e150, 1e86, 1e86}) scale(x, 1);
  const double error = std::abs(path.map()(0, 0) - 0.13);
  EXPECT_GT(error, 1e-3 * 0.13) << "the entry keeps its digits";
  EXPECT_GE(path.rounding(1), error);
}

}  // namespace
}  // namespace corridor::test
