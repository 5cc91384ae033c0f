// Tests of coordinates of the kind `circle` with angles of any size: the edge is the shorter way
// between the stored doubles, in real arithmetic. If rounding hides which way is shorter, the
// verdict must be undecided, never wrongly proved or refuted.
#include <cmath>
#include <numbers>
#include <random>

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/robot/angles.h"
#include "planner/robot/edge_motion.h"
#include "planner/verify/edge_curve.h"
#include "planner/verify/verify_path.h"
#include "tests/planner/verify/rigid_world.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// A number type with enough digits for angles of 10^308 rad, including the part of a turn that is
/// left after whole turns.
using Many = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<400>>;

const Many& pi() {
  static const Many value = boost::math::constants::pi<Many>();
  return value;
}

/// Returns an angle minus whole turns, in [−π, π].
Many reduced(const Many& angle) {
  return angle - 2 * pi() * round(angle / (2 * pi()));
}
Many trueWay(double from, double to) {
  return reduced(Many(to) - Many(from));
}

/// Returns a number of size 10^k to 3·10^k and either sign, with k = 4, 5, …, 25 in turn.
double large(std::mt19937_64& random, int n) {
  const double size = std::pow(10.0, 4 + n % 22);
  return (n % 2 ? -1 : 1) * size * std::uniform_real_distribution(1.0, 3.0)(random);
}

/// The ends of an edge. One of the two angles is large, or both are.
struct Ends {
  double from, to;
  Ends(std::mt19937_64& random, int n) {
    std::uniform_real_distribution<double> small(-3, 3);
    from = n / 44 % 3 == 0 ? small(random) : large(random, n);
    to = n / 44 % 3 == 1 ? small(random) : large(random, n / 2);
    // Sometimes both are large, and close to each other.
    if (n / 44 % 3 == 2 && n % 5 == 0) to = from + small(random);
  }
};

/// A rod that rotates about z, by a coordinate of the kind `circle` (an arm's joint, or a planar
/// body's yaw), and a post that the rod meets at one angle.
struct Sweep {
  KinematicTree tree;
  ConfigurationSpace space;
  ConvexPart rod{{Vec3(0.3, 0, 0), Vec3(1, 0, 0)}, 0.01, false}, post;
  PathProblem problem;
  std::size_t circle = 0;

  Sweep(const Many& angle, double multiplier, bool planar) {
    CoordinateGroup group;
    group.kind = planar ? CoordinateGroup::Kind::planar : CoordinateGroup::Kind::joints;
    if (planar) {
      for (int k = 0; k < 2; ++k) {
        Coordinate line;
        line.lower = -1, line.upper = 1;
        group.coordinates.push_back(space.add(line));
      }
      Frame shift;
      shift.joint = Frame::Joint::translation;
      shift.variable = 0;
      shift.count = 2;
      tree.add(shift);
    }
    Coordinate c;
    c.kind = Coordinate::Kind::circle;
    group.coordinates.push_back(space.add(c));
    circle = space.coordinates().back().first;
    space.addGroup(group);
    Frame turn;
    turn.parent = tree.frames.size() - 1;
    turn.joint = Frame::Joint::revolute;
    turn.variable = circle;
    turn.multiplier = multiplier;
    tree.add(turn);
    const double a = static_cast<double>(reduced(angle));
    post = {{Vec3(0.7 * std::cos(a), 0.7 * std::sin(a), -1),
             Vec3(0.7 * std::cos(a), 0.7 * std::sin(a), 1)},
            0.01,
            false};
    problem.tree = &tree;
    problem.space = &space;
    problem.tolerance = 1e-8;
    problem.tube = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
    problem.bodies = {{"post", nullptr, {&post, 1}, false, 0},
                      {"rod", nullptr, {&rod, 1}, false, tree.frames.size() - 1}};
    problem.pairs = {{0, 1}};
  }
  Sweep(const Sweep&) = delete;

  Configuration at(double angle) const {
    Configuration q = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
    q[static_cast<Eigen::Index>(circle)] = angle;
    return q;
  }
  MotionResult checked(double from, double to) const {
    std::vector<Scene::Placed> placed;
    placed.push_back({Body("post", post), 0});
    placed.push_back({Body("rod", rod), tree.frames.size() - 1});
    const Scene scene(std::move(placed), {{0, 1}});
    EdgeMotion motion(tree, space, scene.framePairs(), problem.tube);
    motion.set(at(from), at(to));
    MotionOptions options;
    options.tolerance = problem.tolerance;
    QueryContext context;
    return scene.certify(motion, options, context);
  }
};

TEST(LargeValues, TheWayRoundACircleIsExact) {
  std::mt19937_64 random(test::testSeed(3));
  for (int n = 0; n < 20'000; ++n) {
    Ends ends(random, n);
    if (n % 7 == 0) ends.to *= std::pow(10.0, n % 280);  // up to the largest doubles
    if (!std::isfinite(ends.to)) continue;
    const Many way = trueWay(ends.from, ends.to);
    if (abs(abs(way) - pi()) < 1e-12) continue;  // either way may be taken
    const Many off = abs(Many(verify::circleDifference(ends.from, ends.to)) - way);
    ASSERT_LE(off, Many(std::ldexp(1.0, -59))) << ends.from << " to " << ends.to;
    const CircleTurn turn = circleTurn(ends.from, ends.to);
    if (!turn.ambiguous()) {
      ASSERT_LE(abs(Many(turn.angle) - way), Many(turn.error)) << ends.from << " to " << ends.to;
    }
    ASSERT_LE(abs(Many(intoCircle(ends.to)) - reduced(Many(ends.to))), Many(0x1p-51)) << ends.to;
  }
}

/// The error that CircleTurn reports is an upper bound for angles of every size, small ones
/// included.
TEST(LargeValues, TheErrorOfAWayIsAsStated) {
  std::mt19937_64 random(test::testSeed(6));
  double worst = 0;  // error as a share of its bound
  for (int n = 0; n < 20'000; ++n) {
    const double size = std::pow(10.0, n % 6 - 2);
    std::uniform_real_distribution<double> angle(-size, size);
    const double from = angle(random), to = angle(random);
    const CircleTurn turn = circleTurn(from, to);
    if (turn.ambiguous()) continue;
    const Many off = abs(Many(turn.angle) - trueWay(from, to));
    ASSERT_LE(off, Many(turn.error)) << from << " to " << to;
    worst = std::max(worst, static_cast<double>(off) / turn.error);
  }
  EXPECT_GT(worst, 0.1) << "a bound that no case comes near is not measured by this test";
}

/// The rod meets a post in the middle of the true way, and does not meet a post that is a half turn
/// away from the first one.
TEST(LargeValues, OnlyThePostOnTheShorterWayIsMet) {
  std::mt19937_64 random(test::testSeed(4));
  int refuted = 0, proved = 0, contact = 0, free = 0;
  const int count = test::casesOf(900, 2'000);
  for (int n = 0; n < count; ++n) {
    const Ends ends(random, n);
    const bool planar = n % 3 == 0;
    const int multiplier = planar ? 1 : n % 4 - 2 == 0 ? 3 : n % 4 - 2;
    const Many way = trueWay(ends.from, ends.to);
    if (abs(multiplier * way) > 2.8 || abs(abs(way) - pi()) < 1e-6) continue;  // meets both posts
    const Many middle = multiplier * (Many(ends.from) + way / 2);
    const std::string what = std::to_string(n) + ": " + std::to_string(ends.from) + " to " +
                             std::to_string(ends.to) + " times " + std::to_string(multiplier);
    {
      const Sweep sweep(middle, multiplier, planar);
      const PathReport report = verifyPath(sweep.problem, {sweep.at(ends.from), sweep.at(ends.to)});
      ASSERT_NE(report.verdict, PathVerdict::proved) << what;
      refuted += report.verdict == PathVerdict::refuted;
      const MotionResult result = sweep.checked(ends.from, ends.to);
      ASSERT_NE(result.verdict, MotionVerdict::free) << what;
      contact += result.verdict == MotionVerdict::contact;
    }
    const Sweep sweep(middle + pi(), multiplier, planar);
    const PathReport report = verifyPath(sweep.problem, {sweep.at(ends.from), sweep.at(ends.to)});
    ASSERT_NE(report.verdict, PathVerdict::refuted) << what;
    const double size = std::max(std::abs(ends.from), std::abs(ends.to));
    if (size < 1e6) {
      ASSERT_EQ(report.verdict, PathVerdict::proved) << what;
    }
    if (size > 1e22 && std::abs(ends.from) > 1e22) {
      ASSERT_EQ(report.verdict, PathVerdict::undecided) << what;
      EXPECT_THAT(report.findings[0].reason,
                  testing::HasSubstr("a joint value or length is too large"))
          << what;
    }
    proved += report.verdict == PathVerdict::proved;
    const MotionResult result = sweep.checked(ends.from, ends.to);
    if (size < 1e6) {
      ASSERT_EQ(result.verdict, MotionVerdict::free) << what;
    }
    if (result.verdict == MotionVerdict::undecided) {
      EXPECT_TRUE(result.reason == UndecidedReason::rounding ||
                  result.reason == UndecidedReason::ambiguous)
          << what;
    }
    free += result.verdict == MotionVerdict::free;
  }
  EXPECT_GT(refuted, count / 7);
  EXPECT_GT(proved, count / 7);
  EXPECT_GT(contact, count / 20);
  EXPECT_GT(free, count / 20);
}

/// States are not brought into [−π, π]: the verdict is that of the angle as it is.
TEST(LargeValues, StatesAreNotWrapped) {
  std::mt19937_64 random(test::testSeed(5));
  for (int n = 0; n < 1'000; ++n) {
    const double angle = large(random, n);
    const Sweep touched(Many(angle), 1, n % 2 == 0), away(Many(angle) + 1, 1, n % 2 == 0);
    EXPECT_NE(verifyPath(touched.problem, {touched.at(angle)}).verdict, PathVerdict::proved);
    EXPECT_NE(verifyPath(away.problem, {away.at(angle)}).verdict, PathVerdict::refuted);
    EXPECT_NE(touched.checked(angle, angle).verdict, MotionVerdict::free) << angle;
    if (std::abs(angle) < 1e6) {
      EXPECT_EQ(verifyPath(away.problem, {away.at(angle)}).verdict, PathVerdict::proved);
      EXPECT_EQ(away.checked(angle, angle).verdict, MotionVerdict::free) << angle;
    }
  }
}

/// A joint that mimics a coordinate of the kind `circle`, with a multiplier that is not a whole
/// number, would jump where the two angles differ by more than half a turn.
TEST(LargeValues, FractionsOfACircleDoNotPassItsSeam) {
  for (const double multiplier : {0.5, -1.5, 2.0}) {
    const Sweep sweep(pi() / 2, multiplier, false);
    const bool whole = multiplier == 2;
    const PathReport report = verifyPath(sweep.problem, {sweep.at(3), sweep.at(-3)});
    EXPECT_EQ(report.verdict, whole ? PathVerdict::proved : PathVerdict::refuted) << multiplier;
    if (!whole) {
      EXPECT_EQ(report.findings[0].reason,
                "a joint that mimics a continuous joint would jump: the two angles of the "
                "continuous joint differ by more than half a turn");
    }
    EXPECT_EQ(sweep.checked(3, -3).verdict, whole ? MotionVerdict::free : MotionVerdict::undecided)
        << multiplier;
    // This edge does not pass the post.
    EXPECT_EQ(verifyPath(sweep.problem, {sweep.at(2), sweep.at(2.2)}).verdict, PathVerdict::proved);
    EXPECT_EQ(sweep.checked(2, 2.2).verdict, MotionVerdict::free) << multiplier;
  }
}

/// Whether a fraction of a circle has a curve depends only on the stored angles, not on whether the
/// edge passes ±180°. If it has one, it is the fraction of the stored angles in between.
TEST(LargeValues, FractionsOfACircleFollowTheStoredAngles) {
  constexpr double turn = 2 * std::numbers::pi;
  struct Edge {
    double from, to;
    bool jumps;
  };
  const Edge edges[] = {
      {3, 4, false},          // passes +180°
      {4, 3, false},          //
      {-3.5, -2.5, false},    // passes −180°
      {3, turn - 3, false},   //
      {9, 10, false},         // passes 3·180°
      {3, -3, true},          // the shorter way passes +180°
      {7, 0.5, true},         // the shorter way passes 0°
      {-1, turn - 1.5, true}  //
  };
  for (const Edge& e : edges)
    for (const double multiplier : {0.5, -1.5, 3.0}) {
      const std::string what = std::to_string(e.from) + " to " + std::to_string(e.to) + " x" +
                               std::to_string(multiplier);
      const double middle = (e.from + e.to) / 2;
      const bool jumps = e.jumps && multiplier != 3;
      // The rod passes the first post at the middle of the stored angles. The second post is where
      // the rod would be with a full turn less.
      const Sweep hit(Many(multiplier) * Many(middle), multiplier, false),
          missed(Many(multiplier) * (Many(middle) - 2 * pi()), multiplier, false);
      const MotionResult checked = hit.checked(e.from, e.to), free = missed.checked(e.from, e.to);
      const PathReport verified = verifyPath(hit.problem, {hit.at(e.from), hit.at(e.to)}),
                       proved = verifyPath(missed.problem, {missed.at(e.from), missed.at(e.to)});
      if (jumps) {
        for (const MotionResult& r : {checked, free}) {
          EXPECT_EQ(r.verdict, MotionVerdict::undecided) << what;
          EXPECT_EQ(r.reason, UndecidedReason::ambiguous) << what;
        }
        for (const PathReport& r : {verified, proved}) {
          ASSERT_EQ(r.verdict, PathVerdict::refuted) << what;
          EXPECT_EQ(r.findings[0].reason,
                    "a joint that mimics a continuous joint would jump: the two angles of the "
                    "continuous joint differ by more than half a turn")
              << what;
        }
      } else if (!e.jumps) {
        EXPECT_EQ(checked.verdict, MotionVerdict::contact) << what;
        EXPECT_EQ(verified.verdict, PathVerdict::refuted) << what;
        EXPECT_NE(verified.findings[0].reason.substr(0, 7), "a joint") << what;
        if (multiplier != 3) {
          EXPECT_EQ(free.verdict, MotionVerdict::free) << what;
          EXPECT_EQ(proved.verdict, PathVerdict::proved) << what;
        }
      } else {  // a whole multiplier: an edge the shorter way round, whatever the stored angles are
        EXPECT_NE(checked.reason, UndecidedReason::ambiguous) << what;
        EXPECT_NE(free.reason, UndecidedReason::ambiguous) << what;
      }
    }
}

}  // namespace
}  // namespace corridor
