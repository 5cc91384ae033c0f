#include "planner/trajectory/time_law.h"

#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/trajectory/natural_spline.h"
#include "tests/planner/trajectory/paths.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

const KinematicTree kEmptyTree;

double durationOf(const std::vector<CurvePiece>& path, const JointLimits& limits,
                  const TimeLawOptions& options = {}) {
  const TimeLaw law = timeLaw(path, jointSpace(static_cast<std::size_t>(limits.velocity.size())),
                              limits, kEmptyTree, options);
  EXPECT_EQ(law.fault, "");
  return law.duration;
}

TEST(TimeLaw, TriangleOfOneJoint) {
  // Half of the length is passed with the acceleration a, half with −a: 2·sqrt(length/a).
  EXPECT_NEAR(durationOf({piece({{0, 2}})}, uniformLimits(1, 100, 3)), 2 * std::sqrt(2.0 / 3),
              1e-12);
}

TEST(TimeLaw, TrapezoidOfOneJoint) {
  // It takes the time v/a to reach the velocity v. The duration is length/v + v/a.
  EXPECT_NEAR(durationOf({piece({{1, -4}})}, uniformLimits(1, 2, 4)), 5 / 2.0 + 2 / 4.0, 1e-12);
}

TEST(TimeLaw, StraightLineWaitsForTheSlowestJoint) {
  JointLimits limits = uniformLimits(3, 1, 1);
  limits.velocity << 2, 0.5, 9;
  limits.acceleration << 1, 8, 0.25;
  // ṡ ≤ min(2/4, 0.5/1, 9/2), s̈ ≤ min(1/4, 8/1, 0.25/2) for the path (4, −1, 2)·s.
  const double v = 0.5, a = 0.125;
  EXPECT_NEAR(durationOf({piece({{0, 4}, {0, -1}, {3, 5}})}, limits),
              v * v / a < 1 ? 1 / v + v / a : 2 * std::sqrt(1 / a), 1e-12);
}

TEST(TimeLaw, RatesAtTheEndsAreKept) {
  // The joint starts at 1 rad/s and ends at 0.5 rad/s, after 3 rad, with a = 1. The limit of
  // velocity is not reached: the largest velocity is v with v² = 3 + (1 + 0.25)/2.
  const double top = std::sqrt(3 + 0.625);
  TimeLawOptions options;
  options.startRate = 1.0 / 3;
  options.endRate = 0.5 / 3;
  EXPECT_NEAR(durationOf({piece({{0, 3}})}, uniformLimits(1, 9, 1), options), top - 1 + top - 0.5,
              1e-12);
  EXPECT_NEAR(durationOf({piece({{0, 1, 2, 3}})}, uniformLimits(1, 9, 1), options),
              top - 1 + top - 0.5, 3e-4);
}

TEST(TimeLaw, ReparametrisationHardlyMatters) {
  // The straight line again, at a rate that varies by a factor of 5 along τ.
  const double fast = durationOf({piece({{0, 2.4}, {0, 1.2}})}, uniformLimits(2, 2, 4));
  EXPECT_NEAR(durationOf({piece({{0, 0.4, 1.2, 2.4}, {0, 0.2, 0.6, 1.2}})}, uniformLimits(2, 2, 4)),
              fast, 5e-3 * fast);
}

/// A straight piece of degree 5, without a limit of velocity, in which another coordinate hardly
/// moves.
TEST(TimeLaw, StraightPiecesNeedNoLimitOfVelocity) {
  JointLimits limits = uniformLimits(2, HUGE_VAL, 1);
  EXPECT_NEAR(
      durationOf({piece({{0, 0.2, 0.4, 0.6, 0.8, 1}, {0, 1e-17, 3e-17, 2e-17, 0, 1e-17}})}, limits),
      2, 1e-3);
}

/// A law with a limit of jerk has a continuous s, ṡ and s̈, although its segments are computed from
/// times that are off by rounding.
TEST(TimeLaw, SmoothLawsAreContinuous) {
  std::mt19937_64 random(testSeed(73));
  const auto number = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  JointLimits limits = uniformLimits(3, 0.8, 1);
  limits.jerk.setConstant(200);
  for (int n = 0; n < 20; ++n) {
    std::vector<Configuration> states;
    for (int k = 0; k < 4; ++k) states.push_back(Eigen::Vector3d(number(), number(), number()));
    const TimeLaw law =
        timeLaw(naturalSpline(states), jointSpace(3), limits, kEmptyTree, {.smooth = true});
    ASSERT_EQ(law.fault, "");
    for (std::size_t k = 0; k + 1 < law.segments.size(); ++k) {
      const LawSegment &a = law.segments[k], &b = law.segments[k + 1];
      const double d = a.duration;
      const double tau = a.tau + d * (a.rate + d / 2 * (a.acceleration + d / 3 * a.jerk));
      EXPECT_NEAR(tau, a.piece == b.piece ? b.tau : 1, 1e-9) << n << ", " << k;
      if (a.piece != b.piece) continue;  // ds/dτ differs
      EXPECT_NEAR(a.rate + d * (a.acceleration + d / 2 * a.jerk), b.rate, 1e-9) << n << ", " << k;
      EXPECT_NEAR(a.acceleration + d * a.jerk, b.acceleration, 1e-6) << n << ", " << k;
    }
  }
}

TEST(TimeLaw, ArcIsLimitedByCentripetalAcceleration) {
  // A long arc with curvature 1/r: with a position's limit, the steady speed is sqrt(a·r). The path
  // is a circle of many turns, made of quintic pieces that are close to it, so most of the way has
  // this speed.
  ConfigurationSpace space;
  CoordinateGroup group{CoordinateGroup::Kind::planar, "base", {}};
  for (const char* name : {"x", "y"})
    group.coordinates.push_back(space.add({Coordinate::Kind::line, name, 0, -9, 9, false, 1}));
  group.coordinates.push_back(space.add(
      {Coordinate::Kind::circle, "yaw", 0, -std::numbers::pi, std::numbers::pi, true, 1}));
  space.addGroup(group);
  const double r = 0.5, step = std::numbers::pi / 8, a = 2;
  const auto arcs = [&](int count) {
    std::vector<CurvePiece> path;
    for (int k = 0; k < count; ++k) {
      const double from = k * step, to = from + step;
      const auto row = [&](auto f, auto g, double sign) {  // quintic Hermite of f, f′ = sign·g
        const double p0 = r * f(from), p1 = r * f(to), v0 = sign * r * g(from) * step,
                     v1 = sign * r * g(to) * step, a0 = -p0 * step * step, a1 = -p1 * step * step;
        return std::vector<double>{
            p0, p0 + v0 / 5, p0 + 0.4 * v0 + a0 / 20, p1 - 0.4 * v1 + a1 / 20, p1 - v1 / 5, p1};
      };
      const auto sine = [](double x) { return std::sin(x); };
      const auto cosine = [](double x) { return std::cos(x); };
      path.push_back(piece({row(cosine, sine, -1), row(sine, cosine, 1), {0, 0, 0, 0, 0, 0}}));
    }
    return path;
  };
  const JointLimits limits = uniformLimits(3, 100, a);
  const TimeLaw longer = timeLaw(arcs(80), space, limits, kEmptyTree),
                shorter = timeLaw(arcs(16), space, limits, kEmptyTree);
  ASSERT_EQ(longer.fault + shorter.fault, "");
  // The two durations differ by that of 64 arcs at the steady speed. The polygon costs up to 0.5 %.
  const double ideal = 64 * step * r / std::sqrt(a * r);
  EXPECT_GE(longer.duration - shorter.duration, ideal * (1 - 1e-5));
  EXPECT_LE(longer.duration - shorter.duration, ideal * 1.005);
}

TEST(TimeLaw, StopsAtCorners) {
  const std::vector<CurvePiece> corner{piece({{0, 1}, {0, 0}}), piece({{1, 1}, {0, 2}})};
  const TimeLaw law = timeLaw(corner, jointSpace(2), uniformLimits(2, 50, 2), kEmptyTree);
  EXPECT_NEAR(law.duration, 2 * std::sqrt(0.5) + 2 * std::sqrt(1.0), 1e-12);
  ASSERT_EQ(law.stopTimes.size(), 1);
  EXPECT_NEAR(law.stopTimes[0], 2 * std::sqrt(0.5), 1e-12);
  const Sample rest = sampleAt(law, corner, law.stopTimes[0]);
  EXPECT_LT(rest.v.norm(), 1e-9);
}

TEST(TimeLaw, PassesThroughStraightJoins) {
  // The same straight line, in pieces of several lengths, with pieces of length 0 between them.
  const std::vector<CurvePiece> path{piece({{0, 0.25}}), piece({{0.25, 0.25}}),
                                     piece({{0.25, 1.5}}), piece({{1.5, 1.75, 2}})};
  EXPECT_NEAR(durationOf(path, uniformLimits(1, 100, 3)), 2 * std::sqrt(2.0 / 3), 1e-3);
}

TEST(TimeLaw, NoLengthTakesNoTime) {
  EXPECT_EQ(durationOf({piece({{1, 1, 1}})}, uniformLimits(1, 1, 1)), 0);
  EXPECT_EQ(durationOf({}, uniformLimits(1, 1, 1)), 0);
}

TEST(TimeLaw, JointAtRestInTheMiddle) {
  // q = τ³ for τ in [−1, 1], as one piece: the tangent is 0 in its middle. The geometry is a
  // straight line of length 2.
  const double ideal = 2 * std::sqrt(2.0 / 3);
  // The optimal law has ṡ = ∞ in the middle. A law whose x = ṡ² is linear between nodes can't
  // follow this, and takes 43 % longer.
  const double slow = durationOf({piece({{-1, 1, -1, 1}})}, uniformLimits(1, 100, 3));
  EXPECT_GE(slow, ideal * (1 - 1e-3));
  EXPECT_LE(slow, 1.5 * ideal);
  // A joint that stands still, or returns, next to one that moves on.
  const double turn = durationOf({piece({{0, 1, 2}, {0, 1, 0}})}, uniformLimits(2, 100, 3));
  EXPECT_GE(turn, 2 * std::sqrt(2.0 / 3) * (1 - 1e-3));
}

TEST(TimeLaw, ScalesDoNotMatter) {
  std::mt19937 random(7);
  const std::vector<CurvePiece> path = randomSpline(3, 4, random);
  const double duration = durationOf(path, uniformLimits(3, 2, 5));
  for (const double scale : {0x1p-60, 0x1p-20, 0x1p20, 0x1p60}) {
    std::vector<CurvePiece> scaled = path;
    for (CurvePiece& part : scaled) part.coefficients *= scale;
    EXPECT_NEAR(durationOf(scaled, uniformLimits(3, 2 * scale, 5 * scale)), duration,
                1e-9 * duration)
        << scale;
    EXPECT_NEAR(durationOf(path, uniformLimits(3, 2 * scale, 5 * scale * scale)) * scale, duration,
                1e-9 * duration)
        << scale;
  }
}

TEST(TimeLaw, Faults) {
  const auto faultOf = [](const std::vector<CurvePiece>& path, const JointLimits& limits,
                          const TimeLawOptions& options = {}) {
    return timeLaw(path, jointSpace(1), limits, kEmptyTree, options).fault;
  };
  const std::vector<CurvePiece> line{piece({{0, 1}})};
  EXPECT_EQ(faultOf(line, uniformLimits(1, 0, 1)),
            "time law: j0 moves, but its limit of velocity is 0; a positive one is needed");
  EXPECT_EQ(faultOf(line, uniformLimits(1, 1, -2)),
            "time law: j0 moves, but its limit of acceleration is -2; a positive one is needed");
  EXPECT_EQ(faultOf({piece({{1, 1}})}, uniformLimits(1, 0, 1)), "");
  EXPECT_EQ(faultOf(line, uniformLimits(1, NAN, 1)),
            "time law: the limits must have 1 numbers each, and no NaN");
  EXPECT_EQ(faultOf({piece({{0, INFINITY}})}, uniformLimits(1, 1, 1)),
            "time law: piece 0 has a number that is not finite");
  TimeLawOptions options;
  options.startRate = 2;  // too fast to stop: v² may be at most 2·a·length = 2
  EXPECT_EQ(faultOf(line, uniformLimits(1, 9, 1), options),
            "time law: piece 0, τ = 0: no law starts with the rate 2 per second within the limits; "
            "at most " +
                std::string("1.4142135623730951") + " is possible");
  options = {};
  options.endRate = 3;
  EXPECT_EQ(faultOf(line, uniformLimits(1, 2, 9), options),
            "time law: piece 0, τ = 1: no law ends with the rate 3 per second within the limits; "
            "at most 2 is possible");
  options.endRate = -1;
  EXPECT_EQ(faultOf(line, uniformLimits(1, 2, 9), options),
            "time law: the rates at start and end must be finite, and 0 or more");
  options.endRate = 1;
  options.smooth = true;
  EXPECT_EQ(faultOf(line, uniformLimits(1, 2, 9), options),
            "time law: a smooth law starts and ends at rest; leave the rates at 0");
}

}  // namespace
}  // namespace corridor::test
