// Corridor's edges in OMPL's state spaces: every angle, half turns, the circle's seam, aliases.
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/planner/checker/boxes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using std::numbers::pi;
using test::Hall;

RigidState turned(double angle, const Vec3& axis = Vec3(1, 2, 3).normalized()) {
  RigidState state;
  state.pose.q = Eigen::AngleAxisd(angle, axis);
  return state;
}

RigidState planar(double yaw) {
  RigidState state;
  state.yaw = yaw;
  return state;
}

TEST(RigidState, SmallAndLargeRotationsAreFollowed) {
  // OMPL 1.5.2 stays at `from` below 9e-5.
  for (const double angle : {1e-300, 1e-12, 1e-9, 5e-5, 8.9e-5, 9e-5, 9.1e-5, 0.1, 1.0, 3.0, pi - 1e-6}) {
    const RigidState from = turned(0), to = turned(angle);
    EXPECT_NEAR(rotationAngle(RigidSpace::SE3, from, to), angle, 1e-15 * (1 + angle));
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const RigidState at = interpolate(RigidSpace::SE3, from, to, t);
      const Eigen::Vector4d expected = turned(t * angle).pose.q.coeffs();
      EXPECT_LE((at.pose.q.coeffs() - expected).norm(), 1e-15) << angle << " at " << t;
      EXPECT_NEAR(distance(RigidSpace::SE3, 1, from, at), t * angle / 2, 1e-15);
    }
  }
}

TEST(RigidState, ShorterArcWhateverTheSigns) {
  RigidState from = turned(0), to = turned(1);
  to.pose.q.coeffs() *= -1;
  EXPECT_NEAR(rotationAngle(RigidSpace::SE3, from, to), 1, 1e-15);
  EXPECT_NEAR(rotationAngle(RigidSpace::SE3, interpolate(RigidSpace::SE3, from, to, 0.5), turned(0.5)), 0, 1e-15);
}

TEST(RigidState, QuaternionsNeedNoNorm) {
  RigidState from = turned(0.3), to = turned(1.1);
  from.pose.q.coeffs() *= 3;
  to.pose.q.coeffs() *= 0.01;
  EXPECT_NEAR(rotationAngle(RigidSpace::SE3, interpolate(RigidSpace::SE3, from, to, 0.5), turned(0.7)), 0, 1e-15);
}

TEST(RigidState, HalfTurnsAreAmbiguousAndNearlyHalfTurnsAreNot) {
  EXPECT_TRUE(ambiguous(RigidSpace::SE3, turned(0), turned(pi)));
  EXPECT_TRUE(ambiguous(RigidSpace::SE3, turned(0), turned(pi - 0.5e-9)));
  EXPECT_FALSE(ambiguous(RigidSpace::SE3, turned(0), turned(pi - 2e-9)));
  EXPECT_TRUE(ambiguous(RigidSpace::SE2, planar(-pi / 2), planar(pi / 2)));
  EXPECT_FALSE(ambiguous(RigidSpace::SE2, planar(-pi / 2), planar(pi / 2 - 2e-9)));
  // Close to it, on either side, the way is the shorter one.
  for (const double angle : {pi - 1e-8, pi + 1e-8}) {
    const RigidState middle = interpolate(RigidSpace::SE3, turned(0), turned(angle), 0.5);
    const double expected = angle < pi ? angle / 2 : (angle - 2 * pi) / 2;
    EXPECT_NEAR(rotationAngle(RigidSpace::SE3, middle, turned(expected)), 0, 1e-7);
  }
}

TEST(RigidState, CircleTheShorterWayAcrossTheSeam) {
  const auto at = [](double from, double to, double t) { return interpolate(RigidSpace::SE2, planar(from), planar(to), t).yaw; };
  EXPECT_NEAR(at(3, -3, 0.5), pi, 1e-15);
  EXPECT_NEAR(at(3, -3, 0.25), 3 + (2 * pi - 6) / 4, 1e-15);
  EXPECT_NEAR(at(-3, 3, 0.75), 3 + (2 * pi - 6) / 4, 1e-15);
  EXPECT_EQ(at(pi, -pi, 0.5), pi);  // the same angle
  EXPECT_EQ(distance(RigidSpace::SE2, 1, planar(pi), planar(-pi)), 0);
  // Out of range: comes back inside.
  EXPECT_NEAR(at(7, 7.5, 0), 7 - 2 * pi, 1e-15);
  EXPECT_NEAR(at(7, 7.5, 1), 7.5 - 2 * pi, 1e-15);
  EXPECT_NEAR(at(100, -100, 0.5), std::remainder(100 + std::remainder(-200, 2 * pi) / 2, 2 * pi), 1e-13);
  for (const double yaw : {-20.0, -pi, pi, 4.0, 1e6})
    for (const double t : {0.0, 0.3, 1.0}) EXPECT_LE(std::abs(at(yaw, yaw + 0.1, t)), pi);
}

TEST(RigidState, EndsAreBitForBitAndPositionsStayInTheirBox) {
  std::mt19937_64 random(test::testSeed(1));
  std::uniform_real_distribution<double> u(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    RigidState a, b;
    a.pose.p = 1e3 * Vec3(u(random), u(random), u(random));
    b.pose.p = 1e-3 * Vec3(u(random), u(random), u(random));
    a.pose.q = Eigen::Quaterniond(u(random), u(random), u(random), u(random));
    b.pose.q = Eigen::Quaterniond(u(random), u(random), u(random), u(random));
    EXPECT_EQ(interpolate(RigidSpace::SE3, a, b, 0).pose.q.coeffs(), a.pose.q.coeffs());
    EXPECT_EQ(interpolate(RigidSpace::SE3, a, b, 1).pose.q.coeffs(), b.pose.q.coeffs());
    EXPECT_EQ(interpolate(RigidSpace::SE3, a, b, 1).pose.p, b.pose.p);
    const double t = 1 - std::ldexp(std::abs(u(random)), -int(i % 53));
    const Vec3 p = interpolate(RigidSpace::SE3, a, b, t).pose.p;
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(p[k], std::max(a.pose.p[k], b.pose.p[k]));
      EXPECT_GE(p[k], std::min(a.pose.p[k], b.pose.p[k]));
    }
  }
}

TEST(RigidState, DistanceIsWeighted) {
  RigidState a, b = turned(0.5);
  b.pose.p = {3, 4, 0};
  EXPECT_NEAR(distance(RigidSpace::SE3, 2, a, b), 5 + 2 * 0.25, 1e-15);
  RigidState c = planar(0.5);
  c.pose.p = {3, 4, 0};
  EXPECT_NEAR(distance(RigidSpace::SE2, 2, planar(0), c), 5 + 2 * 0.5, 1e-15);
}

class StateSpaces : public testing::TestWithParam<RigidSpace> {};

TEST_P(StateSpaces, PassOmplsSanityChecks) {
  const auto space = makeStateSpace(GetParam(), {-1, -2, -3}, {4, 5, 6}, 0.7);
  space->setup();
  EXPECT_NO_THROW(space->sanityChecks());
}

TEST_P(StateSpaces, OutputMayBeEitherInput) {
  const Hall hall(GetParam());
  const RigidState a = hall.at(-3, 1, 0.2), b = hall.at(2, 0, 1.5);
  const RigidState expected = interpolate(GetParam(), a, b, 0.3);
  for (const bool first : {true, false}) {
    auto s = hall.scoped(a), t = hall.scoped(b);
    ompl::base::State* out = first ? s.get() : t.get();
    hall.si->getStateSpace()->interpolate(s.get(), t.get(), 0.3, out);
    EXPECT_EQ(distance(GetParam(), 1, readState(GetParam(), out), expected), 0);
  }
}

TEST_P(StateSpaces, TinyDifferencesAreDifferent) {
  const Hall hall(GetParam());
  const auto a = hall.scoped(hall.at(0, 0, 0.5)), b = hall.scoped(hall.at(0, 0, 0.5 + 1e-7)), c = hall.scoped(hall.at(0, 0, 0.5));
  EXPECT_FALSE(hall.si->equalStates(a.get(), b.get()));
  EXPECT_GT(hall.si->distance(a.get(), b.get()), 0);
  EXPECT_TRUE(hall.si->equalStates(a.get(), c.get()));
  EXPECT_EQ(hall.si->distance(a.get(), c.get()), 0);
}

INSTANTIATE_TEST_SUITE_P(Both, StateSpaces, testing::Values(RigidSpace::SE2, RigidSpace::SE3));

}  // namespace
}  // namespace corridor
