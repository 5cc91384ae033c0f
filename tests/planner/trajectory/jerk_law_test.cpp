#include "planner/trajectory/jerk_law.h"  // tested through timeLaw, with the option `smooth`

#include <cmath>

#include <gtest/gtest.h>

#include "planner/trajectory/emit.h"
#include "tests/planner/trajectory/paths.h"

namespace corridor::test {
namespace {

const KinematicTree kNoLinks;

/// Returns the shortest time along a length from rest to rest: the profile of seven constant jerks.
double sevenSegments(double length, double v, double a, double j) {
  const double rise =
      v * j < a * a ? 2 * std::sqrt(v / j) : v / a + a / j;  // seconds to reach the velocity v
  if (length >= v * rise) return length / v + rise;
  if (length <= 2 * a * a * a / (j * j)) return 4 * std::cbrt(length / (2 * j));
  // The largest velocity that is reached, p, satisfies p·(p/a + a/j) = length.
  const double p = a / 2 * (std::sqrt(a * a / (j * j) + 4 * length / a) - a / j);
  return 2 * (p / a + a / j);
}

TimeLaw smoothOf(const std::vector<CurvePiece>& path, const JointLimits& limits,
                 const KinematicTree& tree = kNoLinks) {
  const TimeLaw law = timeLaw(path, jointSpace(static_cast<std::size_t>(limits.velocity.size())),
                              limits, tree, {.smooth = true});
  EXPECT_EQ(law.fault, "");
  return law;
}

/// Returns two lines of length `reach` at a right angle, whose corner is rounded by a curve of
/// degree 5 that takes `size` of each (as smooth_path.h does).
std::vector<CurvePiece> roundedCorner(double reach, double size) {
  const double h = size / 2;
  return {piece({{0, reach - size}, {0, 0}}),
          piece({{reach - size, reach - h, reach, reach, reach, reach}, {0, 0, 0, 0, h, size}}),
          piece({{reach, reach}, {size, reach}})};
}

TEST(JerkLaw, SevenSegmentsAreFound) {
  // Every case of the profile, for a straight line in three parametrisations. Only for the first
  // parametrisation, which has a constant rate, does the law use this formula.
  const struct {
    double length, velocity, acceleration, jerk;
  } cases[] = {{2, 1, 2, 8},  {2, 1, 2, 3},   {1, 9, 2, 9},
               {1, 9, 90, 9}, {3, 0.5, 9, 2}, {5, 1, 1, 20}};
  for (const auto& c : cases) {
    const double ideal = sevenSegments(c.length, c.velocity, c.acceleration, c.jerk);
    const JointLimits limits = uniformLimits(2, c.velocity, c.acceleration, c.jerk);
    for (const std::vector<double>& at :
         {std::vector<double>{0, 1}, {0, 0.15, 0.55, 1}, {0, 0.3, 0.4, 0.45, 0.7, 1}}) {
      std::vector<double> x, y;
      for (const double share : at) {
        x.push_back(c.length * share);
        y.push_back(0.4 - x.back() / 2);
      }
      const double found = smoothOf({piece({x, y})}, limits).duration;
      EXPECT_GE(found, ideal * (1 - 1e-9)) << c.length << ' ' << c.jerk << ' ' << at.size();
      EXPECT_LE(found, ideal * (at.size() == 2 ? 1 + 1e-9 : 1.025))
          << c.length << ' ' << c.jerk << ' ' << at.size();
    }
  }
}

TEST(JerkLaw, SmallCornersSlowDownOnlyThere) {
  const JointLimits limits = uniformLimits(2, 1, 2, 20);
  const double stopping = 2 * sevenSegments(3, 1, 2, 20);
  double before = INFINITY;
  for (const double size : {1e-4, 1e-3, 1e-2, 1e-1, 1.0}) {
    const TimeLaw law = smoothOf(roundedCorner(3, size), limits);
    // The curve's second derivative is 0 at its ends, so the robot does not stop there.
    EXPECT_TRUE(law.stopTimes.empty()) << size;
    EXPECT_LE(law.duration, 1.02 * stopping) << size;
    EXPECT_LE(law.duration, before) << size;
    before = law.duration;
  }
}

TEST(JerkLaw, LooseLimitsCostLittle) {
  const unsigned seed = 20180808;
  std::mt19937 random(seed);
  for (int i = 0; i < 2; ++i) {
    const std::vector<CurvePiece> path = randomSpline(3, 8, random);
    const double free = timeLaw(path, jointSpace(3), uniformLimits(3, 2, 5), kNoLinks).duration;
    for (const double jerk : {5000.0, 500.0, 100.0, 30.0}) {
      const JointLimits limits = uniformLimits(3, 2, 5, jerk);
      const TimeLaw law = smoothOf(path, limits);
      const Emission rows =
          emitRows(law, path, jointSpace(3), limits, kNoLinks, {.degree = 5, .deviation = 1e-3});
      ASSERT_EQ(rows.fault, "");
      EXPECT_LE(rows.ratios.jerk.share, 1);
      EXPECT_LE(rows.stretch, 1.01) << "seed " << seed << ", path " << i << ", jerk " << jerk;
      // The time to reach an acceleration is 5/jerk, and there are some 12 switches in 5 s.
      EXPECT_LE(rows.duration, free * (1.01 + 2.5 / jerk))
          << "seed " << seed << ", path " << i << ", jerk " << jerk;
    }
  }
}

TEST(JerkLaw, ALinkSlowsOnlyTheJointsThatMoveIt) {
  // The first joint moves a link of 2 m, whose speed is limited to 0.5 m/s; the second joint is
  // fast. On the first half of the path only the second joint moves, on the second half the first
  // joint, with a rounded corner between the halves.
  KinematicTree tree;
  Frame frame;
  frame.joint = Frame::Joint::revolute;
  frame.variable = 1;
  tree.add(frame);
  JointLimits limits = uniformLimits(2, 2, 4, 40);
  limits.links.push_back({"arm", 1, 0.5, {Eigen::Vector3d::Zero(), Eigen::Vector3d(2, 0, 0)}});
  const TimeLaw law = smoothOf(roundedCorner(2, 0.05), limits, tree);
  const double slow = sevenSegments(2, 0.25, 4, 40), fast = sevenSegments(2, 2, 4, 40);
  EXPECT_LE(law.duration, slow + fast);
  EXPECT_GE(law.duration, 2 / 0.25);
  const Emission rows = emitRows(law, roundedCorner(2, 0.05), jointSpace(2), limits, tree,
                                 {.degree = 5, .deviation = 1e-3});
  ASSERT_EQ(rows.fault, "");
  EXPECT_LE(rows.ratios.link.share, 1);
  EXPECT_LE(rows.stretch, 1.01);
}

}  // namespace
}  // namespace corridor::test
