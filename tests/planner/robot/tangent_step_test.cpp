#include "planner/robot/tangent_step.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "planner/robot/difference.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Returns a space of a slide in [−1, 1], a revolute joint, a continuous joint, and a floating
/// base.
ConfigurationSpace everyKind() {
  using Kind = Coordinate::Kind;
  ConfigurationSpace space;
  CoordinateGroup joints{CoordinateGroup::Kind::joints, "", {}},
      base{CoordinateGroup::Kind::floating, "base", {}};
  joints.coordinates = {space.add({Kind::line, "slide", 0, -1, 1, false, 3}),
                        space.add({Kind::line, "lift", 0, -2, 2, true, 1}),
                        space.add({Kind::circle, "pan", 0, 0, 0, true, 2})};
  for (const char* name : {"x", "y", "z"})
    base.coordinates.push_back(space.add({Kind::line, name, 0, -5, 5, false, 1}));
  base.coordinates.push_back(space.add({Kind::rotation, "rotation", 0, 0, 0, true, 0.5}));
  space.addGroup(joints);
  space.addGroup(base);
  return space;
}

Configuration somewhere(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-0.9, 0.9);
  Configuration q(10);
  for (double& number : q) number = unit(random);
  return q;
}

TEST(TangentStep, WeightsGiveTheDistanceOfAStep) {
  const ConfigurationSpace space = everyKind();
  ASSERT_EQ(tangentSize(space), 9);
  const TangentStep weights = tangentWeights(space);
  std::mt19937_64 random(test::testSeed(2510));
  for (int n = 0; n < 20; ++n) {
    Configuration q = somewhere(random);
    space.normalise(q);
    for (Eigen::Index i = 0; i < 9; ++i) {
      const double length = n % 2 ? 1e-3 : -0.05;
      const Configuration moved = displaced(space, q, length * TangentStep::Unit(9, i));
      EXPECT_NEAR(space.distance(q, moved), weights[i] * std::abs(length), 1e-12) << i;
    }
  }
}

TEST(TangentStep, StepsBetweenConfigurationsLeadThere) {
  const ConfigurationSpace space = everyKind();
  const TangentStep weights = tangentWeights(space);
  std::mt19937_64 random(test::testSeed(5702));
  std::uniform_real_distribution<double> scale(-3, 3);
  for (int n = 0; n < 200; ++n) {
    const Configuration from = somewhere(random);
    Configuration to = somewhere(random);
    to[2] *= 3;                     // an angle of up to 2.7 rad
    to.tail<4>() *= scale(random);  // quaternions of any norm and sign
    const TangentStep step = stepBetween(space, from, to);
    EXPECT_LE(std::abs(step[2]), std::numbers::pi);
    EXPECT_LE(step.tail<3>().norm(), std::numbers::pi);
    EXPECT_LT(space.distance(displaced(space, from, step), to), 1e-7);
    EXPECT_NEAR(weightedLength(space, from, to, weights), step.cwiseProduct(weights).norm(), 1e-12);
    EXPECT_EQ(stepBetween(space, from, from), TangentStep(TangentStep::Zero(9)));
  }
}

TEST(TangentStep, RotatesInTheFrameBeforeTheRotation) {
  const ConfigurationSpace space = everyKind();
  Configuration q = Configuration::Zero(10);
  q.tail<4>() << std::sqrt(0.5), 0, 0, std::sqrt(0.5);  // 90° about x
  TangentStep step = TangentStep::Zero(9);
  step.tail<3>() << 0, 0, std::numbers::pi / 2;
  const Configuration moved = displaced(space, q, step);
  const Eigen::Quaterniond rotation(moved.data() + 6);
  // The step adds a rotation of 90° about the z axis of the reference frame after the rotation of
  // 90° about x. The first rotation takes y to z; the second does not change z.
  EXPECT_LT((rotation * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((rotation * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-15);
}

TEST(TangentStep, EndsAtBoundsAndWrapsAngles) {
  const ConfigurationSpace space = everyKind();
  Configuration q = Configuration::Zero(10);
  q[9] = 1;
  q[2] = 3;
  TangentStep step = TangentStep::Zero(9);
  step[0] = 7;    // the slide stops at its upper bound, 1
  step[1] = -7;   // the lift stops at its lower bound, -2
  step[2] = 0.5;  // pan would be at 3.5 rad, which becomes 3.5 - 2π
  const Configuration moved = displaced(space, q, step);
  EXPECT_EQ(moved[0], 1);
  EXPECT_EQ(moved[1], -2);
  EXPECT_NEAR(moved[2], 3.5 - 2 * std::numbers::pi, 1e-15);
  // A value that is already out of its bounds is not moved into the bounds.
  q[0] = 1.5;
  step[0] = 0.25;
  EXPECT_EQ(displaced(space, q, step)[0], 1.5);
  step[0] = -0.25;
  EXPECT_EQ(displaced(space, q, step)[0], 1.25);
}

}  // namespace
}  // namespace corridor
