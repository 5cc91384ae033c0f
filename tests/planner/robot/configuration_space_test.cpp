// Tests of edges and distances: angles of every size, half turns, angles across ±π, and edges whose
// ends are equal bit for bit.
#include "planner/robot/configuration_space.h"

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/transform.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using std::numbers::pi;
using CoordinateKind = Coordinate::Kind;

Coordinate coordinate(CoordinateKind kind, std::string name, double weight = 1, double lower = -10,
                      double upper = 10) {
  Coordinate c;
  c.kind = kind;
  c.name = std::move(name);
  c.weight = weight;
  c.lower = lower;
  c.upper = upper;
  return c;
}

/// Returns a space of one coordinate of the given kind.
ConfigurationSpace single(CoordinateKind kind) {
  ConfigurationSpace space;
  space.addGroup({CoordinateGroup::Kind::joints, "", {space.add(coordinate(kind, "q"))}});
  return space;
}

ConfigurationSpace floating(double rotationWeight = 1) {
  ConfigurationSpace space;
  CoordinateGroup group{CoordinateGroup::Kind::floating, "left", {}};
  for (const char* name : {"left/x", "left/y", "left/z"})
    group.coordinates.push_back(space.add(coordinate(CoordinateKind::line, name)));
  group.coordinates.push_back(
      space.add(coordinate(CoordinateKind::rotation, "left/rotation", rotationWeight)));
  space.addGroup(group);
  return space;
}

ConfigurationSpace planar(double rotationWeight = 1) {
  ConfigurationSpace space;
  CoordinateGroup group{CoordinateGroup::Kind::planar, "", {}};
  for (const char* name : {"x", "y"})
    group.coordinates.push_back(space.add(coordinate(CoordinateKind::line, name)));
  group.coordinates.push_back(space.add(coordinate(CoordinateKind::circle, "yaw", rotationWeight)));
  space.addGroup(group);
  return space;
}

Configuration values(std::initializer_list<double> numbers) {
  Configuration q(static_cast<Eigen::Index>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), q.data());
  return q;
}

Configuration turned(double angle, const Vec3& axis = Vec3(1, 2, 3).normalized()) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)).coeffs();
}

TEST(ConfigurationSpace, SmallAndLargeRotationsAreFollowed) {
  const ConfigurationSpace space = single(CoordinateKind::rotation);
  // For angles below 9e-5, OMPL 1.5.2 would return `from`.
  for (const double angle :
       {1e-300, 1e-12, 1e-9, 5e-5, 8.9e-5, 9e-5, 9.1e-5, 0.1, 1.0, 3.0, pi - 1e-6}) {
    const Configuration from = turned(0), to = turned(angle);
    EXPECT_NEAR(space.largestTurn(from, to), angle, 1e-15 * (1 + angle));
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Configuration at = space.interpolate(from, to, t);
      EXPECT_LE((at - turned(t * angle)).norm(), 1e-15) << angle << " at " << t;
      EXPECT_NEAR(space.distance(from, at), t * angle / 2, 1e-15);
    }
  }
}

TEST(ConfigurationSpace, RotationsTakeTheShorterArcWhateverSignAndNorm) {
  const ConfigurationSpace space = single(CoordinateKind::rotation);
  EXPECT_NEAR(space.largestTurn(turned(0), -turned(1)), 1, 1e-15);
  for (const double size : {1.0, 3.0, 1e-3, 1e-300, 1e300}) {
    const Configuration at = space.interpolate(turned(0.3), -size * turned(1.1), 0.5);
    EXPECT_NEAR(space.largestTurn(at, turned(0.7)), 0, 1e-15) << size;
    Configuration q = size * turned(1.1);
    space.normalise(q);
    EXPECT_NEAR(q.norm(), 1, 1e-15) << size;
  }
}

TEST(ConfigurationSpace, HalfTurnsAreAmbiguousAndNearlyHalfTurnsAreNot) {
  const ConfigurationSpace rotation = single(CoordinateKind::rotation),
                           circle = single(CoordinateKind::circle);
  EXPECT_TRUE(rotation.ambiguous(turned(0), turned(pi)));
  EXPECT_TRUE(rotation.ambiguous(turned(0), turned(pi - 0.5e-9)));
  EXPECT_FALSE(rotation.ambiguous(turned(0), turned(pi - 2e-9)));
  EXPECT_TRUE(circle.ambiguous(values({-pi / 2}), values({pi / 2})));
  EXPECT_FALSE(circle.ambiguous(values({-pi / 2}), values({pi / 2 - 2e-9})));
  EXPECT_FALSE(single(CoordinateKind::line).ambiguous(values({-pi / 2}), values({pi / 2})));
  // If the difference is a little below or above a half turn, the edge goes the shorter way.
  for (const double angle : {pi - 1e-8, pi + 1e-8}) {
    const Configuration middle = rotation.interpolate(turned(0), turned(angle), 0.5);
    const double expected = angle < pi ? angle / 2 : (angle - 2 * pi) / 2;
    EXPECT_NEAR(rotation.largestTurn(middle, turned(expected)), 0, 1e-7);
  }
}

TEST(ConfigurationSpace, CirclesTakeTheShorterWayAcrossTheSeam) {
  const ConfigurationSpace space = single(CoordinateKind::circle);
  const auto at = [&](double from, double to, double t) {
    return space.interpolate(values({from}), values({to}), t)[0];
  };
  EXPECT_NEAR(at(3, -3, 0.5), pi, 1e-15);
  EXPECT_NEAR(at(3, -3, 0.25), 3 + (2 * pi - 6) / 4, 1e-15);
  EXPECT_NEAR(at(-3, 3, 0.75), 3 + (2 * pi - 6) / 4, 1e-15);
  EXPECT_EQ(at(pi, -pi, 0.5), pi);  // the same angle
  EXPECT_EQ(space.distance(values({pi}), values({-pi})), 0);
  EXPECT_TRUE(space.equal(values({pi}), values({-pi})));
  EXPECT_NEAR(space.largestTurn(values({3}), values({-3})), 2 * pi - 6, 1e-15);
  // For a coordinate of the kind `circle`, an angle outside of [−π, π] is brought into this
  // interval.
  EXPECT_NEAR(at(7, 7.5, 0), 7 - 2 * pi, 1e-15);
  EXPECT_NEAR(at(7, 7.5, 1), 7.5 - 2 * pi, 1e-15);
  EXPECT_NEAR(at(100, -100, 0.5), std::remainder(100 + std::remainder(-200, 2 * pi) / 2, 2 * pi),
              1e-13);
  for (const double angle : {-20.0, -pi, pi, 4.0, 1e6})
    for (const double t : {0.0, 0.3, 1.0}) EXPECT_LE(std::abs(at(angle, angle + 0.1, t)), pi);
}

TEST(ConfigurationSpace, EndsAreBitForBitAndLinesStayBetweenThem) {
  const ConfigurationSpace space = floating();
  std::mt19937_64 random(test::testSeed(1));
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    Configuration a(7), b(7);
    for (Eigen::Index k = 0; k < 7; ++k) {
      a[k] = (k < 3 ? 1e3 : 1) * u(random);
      b[k] = (k < 3 ? 1e-3 : 1) * u(random);
    }
    EXPECT_EQ(space.interpolate(a, b, 0), a);
    EXPECT_EQ(space.interpolate(a, b, 1), b);
    const double t = 1 - std::ldexp(std::abs(u(random)), -int(i % 53));
    const Configuration p = space.interpolate(a, b, t);
    for (Eigen::Index k = 0; k < 3; ++k) {
      EXPECT_LE(p[k], std::max(a[k], b[k]));
      EXPECT_GE(p[k], std::min(a[k], b[k]));
    }
  }
}

TEST(ConfigurationSpace, DistancesAreWeightedAndSummedOverGroups) {
  Configuration a = Configuration::Zero(7), b(7);
  a.tail<4>() = turned(0);
  b << 3, 4, 0, turned(0.5);
  EXPECT_NEAR(floating(2).distance(a, b), 5 + 2 * 0.25, 1e-15);
  EXPECT_NEAR(planar(2).distance(values({0, 0, 3}), values({3, 4, -3})), 5 + 2 * (2 * pi - 6),
              1e-15);

  ConfigurationSpace mobile = planar(2);
  mobile.addGroup({CoordinateGroup::Kind::joints,
                   "",
                   {mobile.add(coordinate(CoordinateKind::line, "lift", 3)),
                    mobile.add(coordinate(CoordinateKind::circle, "pan", 0.5))}});
  EXPECT_NEAR(mobile.distance(values({0, 0, 0, 0, 3}), values({3, 4, 1, 1, -3})),
              5 + 2 + std::hypot(3, 0.5 * (2 * pi - 6)), 1e-14);
}

TEST(ConfigurationSpace, DistanceIsZeroForEqualConfigurationsOnly) {
  const ConfigurationSpace arm = single(CoordinateKind::line), body = floating();
  for (const double step : {1e-7, 1e-170, 5e-324}) {
    EXPECT_GT(arm.distance(values({0}), values({step})), 0);
    EXPECT_FALSE(arm.equal(values({0}), values({step})));
    Configuration a(7), b(7);
    a << 0, 0, 0, turned(1);
    b << 0, step, 0, turned(1);
    EXPECT_GT(body.distance(a, b), 0);
    EXPECT_FALSE(body.equal(a, b));
    EXPECT_EQ(body.distance(a, a), 0);
    EXPECT_TRUE(body.equal(a, a));
  }
  EXPECT_EQ(arm.distance(values({-1e200}), values({1e200})), 2e200);
  EXPECT_EQ(arm.distance(values({0}), values({1e-170})), 1e-170);
  Configuration a(7), b(7);
  a << -3e200, 0, 0, turned(1);
  b << 0, 4e200, 0, turned(1);
  EXPECT_NEAR(body.distance(a, b), 5e200, 1e186);
  a << 1, 2, 3, 3 * turned(1);
  b = a;
  body.normalise(b);
  EXPECT_TRUE(body.equal(a, b));  // equal after normalising
  b.tail<4>() = turned(1 + 1e-7);
  EXPECT_FALSE(body.equal(a, b));
  EXPECT_GT(body.distance(a, b), 0);
}

TEST(ConfigurationSpace, BoundsAreInclusiveAndForLinesOnly) {
  ConfigurationSpace space;
  space.add(coordinate(CoordinateKind::line, "lift", 1, -1, 2));
  space.add(coordinate(CoordinateKind::circle, "pan", 1, 0, 0));
  EXPECT_TRUE(space.inBounds(values({-1, 3})));
  EXPECT_TRUE(space.inBounds(values({2, -100})));
  EXPECT_FALSE(space.inBounds(values({std::nextafter(2, 3), 0})));
  EXPECT_FALSE(space.inBounds(values({std::nan(""), 0})));
}

TEST(ConfigurationSpace, FiniteMeansUsable) {
  const ConfigurationSpace space = floating();
  EXPECT_TRUE(space.isFinite(values({0, 0, 0, 0, 0, 0, 1e-300})));
  EXPECT_FALSE(space.isFinite(values({0, 0, 0, 0, 0, 0, 0})));
  EXPECT_FALSE(space.isFinite(values({0, INFINITY, 0, 0, 0, 0, 1})));
  EXPECT_FALSE(space.isFinite(values({0, 0, 0, 0, std::nan(""), 0, 1})));
}

TEST(ConfigurationSpace, NumbersHaveNames) {
  EXPECT_THAT(floating().numberNames(),
              testing::ElementsAre("left/x", "left/y", "left/z", "left/qx", "left/qy", "left/qz",
                                   "left/qw"));
  EXPECT_THAT(planar().numberNames(), testing::ElementsAre("x", "y", "yaw"));
}

TEST(ConfigurationSpace, NormaliseBringsAnglesBack) {
  const ConfigurationSpace space = planar();
  Configuration q = values({7, 8, 4});
  space.normalise(q);
  EXPECT_EQ(q.head(2), values({7, 8}));
  EXPECT_NEAR(q[2], 4 - 2 * pi, 1e-15);
  q = values({7, 8, -pi});
  space.normalise(q);
  EXPECT_EQ(q[2], -pi);
}

}  // namespace
}  // namespace corridor
