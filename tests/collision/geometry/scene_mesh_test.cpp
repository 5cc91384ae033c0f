// The bound of the rounding of transforms, against products in more digits.
#include "collision/geometry/scene_mesh.h"

#include <cmath>
#include <numbers>
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
    const Eigen::Affine3d turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
    EXPECT_TRUE(
        NodePath().below(Eigen::Affine3d(Eigen::Scaling(s, -s, 1.0))).below(turn).isMirrored())
        << s;
  }
}

/// The rounding of a decimal angle beyond a turn is more than that of the map's entries.
TEST(NodePath, LargeAngles) {
  const double degrees = 999'999.3;
  const Eigen::Affine3d turn(
      Eigen::AngleAxisd(std::fmod(degrees, 360) * (std::numbers::pi / 180), Vec3::UnitZ()));
  // The decimal's double is off by up to half an ulp, which the fmod keeps.
  const double off = 0x1p-53 * degrees * (std::numbers::pi / 180);
  const Eigen::Affine3d far(Eigen::Translation3d(1e9, 0, 0));
  EXPECT_LT(NodePath().below(turn).below(far).rounding(0), 1e9 * off);
  EXPECT_GE(NodePath().below(turn, off).below(far).rounding(0), 1e9 * off);
}

/// Translations that cancel lose what is small between them.
TEST(NodePath, TheLengthOfTranslationsThatCancel) {
  NodePath path;
  for (const double x : {1e16, 0.3, -1e16})
    path = path.below(Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)));
  EXPECT_GE(path.length(), 2e16);
  EXPECT_GE(path.rounding(0), std::abs(path.map().translation().x() - 0.3));
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
