#include "planner/solve/make_trajectory.h"

#include <cmath>

#include <gtest/gtest.h>

#include "planner/solve/verify_solution.h"
#include "tests/planner/problem/problem_fixture.h"

namespace corridor {
namespace {

/// A square with edges of 0.2 m moves in the plane, above a floor whose top is at y = 0, around a
/// post.
class MakeTrajectory : public test::SquareTest {
 protected:
  Problem problemWith(const std::string& more = "") const {
    return read(
        "format: corridor-problem-1\nrobot: square.yaml\nworld:\n"
        "  floor: {box: [10, 1, 1], at: [0, -0.5, 0]}\n"
        "  post: {box: [0.2, 1, 1], at: [1, 0.5, 0]}\n"
        "start: {at: [0, 0.2]}\ngoal: {at: [2, 0.2]}\nbounds: {at: [[-3, -3], [5, 5]]}\n" +
        more);
  }
  static Path overThePost() { return {at(0, 0.2), at(0.5, 1.3), at(1.5, 1.3), at(2, 0.2)}; }
  static VerifyReport verified(const Problem& problem, const MadeTrajectory& made) {
    return verifyTrajectory(problem, readTrajectory("made", made.text, problem.model));
  }
};

TEST_F(MakeTrajectory, IsProvedAsItIsWritten) {
  const Problem problem = problemWith();
  const Checker checker(problem);
  for (const TrajectoryFileKind kind : {TrajectoryFileKind::csv, TrajectoryFileKind::message}) {
    const MadeTrajectory made = makeTrajectory(problem, checker, overThePost(), kind);
    EXPECT_EQ(made.fault, "");
    EXPECT_TRUE(made.proved());
    EXPECT_EQ(made.corners, 2u);
    EXPECT_EQ(made.rounded, 2u);
    EXPECT_TRUE(keepsLimits(made.ratios)) << made.ratios.acceleration.share;
    EXPECT_GT(made.ratios.acceleration.share, 0.99);
    const VerifyReport report = verified(problem, made);
    EXPECT_EQ(report.verdict, PathVerdict::proved);
    EXPECT_TRUE(report.reachesGoal);
    ASSERT_TRUE(report.limits);
    EXPECT_TRUE(keepsLimits(*report.limits));
    EXPECT_EQ(report.times.back(), made.duration);
  }
}

/// Returns the smallest distance of the square from the post at samples of a curve. The square does
/// not turn.
double leastDistanceFromPost(const std::vector<CurvePiece>& pieces) {
  double least = HUGE_VAL;
  for (const CurvePiece& piece : pieces)
    for (int i = 0; i <= 50; ++i) {
      Eigen::MatrixXd c = piece.coefficients;  // de Casteljau
      for (Eigen::Index rest = c.cols() - 1; rest > 0; --rest)
        c.leftCols(rest) =
            ((1 - i / 50.0) * c.leftCols(rest) + i / 50.0 * c.middleCols(1, rest)).eval();
      const double right = std::abs(c(0, 0) - 1) - 0.2, up = c(1, 0) - 1.1;
      least = std::min(least, std::hypot(std::max(right, 0.0), std::max(up, 0.0)));
    }
  return least;
}

TEST_F(MakeTrajectory, KeepsTheClearanceOfThePath) {
  const Problem problem = problemWith();
  const Checker checker(problem);
  const ClearanceTargets targets(checker, 0.19, overThePost().front(), overThePost().back());
  const CurveClearance clearance(checker, targets, targets.least());
  for (const TrajectoryFileKind kind : {TrajectoryFileKind::csv, TrajectoryFileKind::message}) {
    const auto made = [&](const CurveClearance* wanted) {
      return makeTrajectory(
          problem, checker, overThePost(), kind, [] { return false; }, wanted);
    };
    const MadeTrajectory closer = made(nullptr), kept = made(&clearance);
    EXPECT_LT(leastDistanceFromPost(closer.curve.pieces), 0.15);
    EXPECT_FALSE(closer.clearance);
    EXPECT_GE(leastDistanceFromPost(kept.curve.pieces), 0.19);
    EXPECT_TRUE(kept.isGood());
    ASSERT_TRUE(kept.clearance);
    EXPECT_EQ(kept.clearance->shareOnTarget, 1);
    EXPECT_NEAR(kept.clearance->proved, targets.least(), 1e-3);  // 0.07: the floor at the start
    EXPECT_GT(kept.rounded, 0u);
    // The law along the closer curve is compared before its rows are made, which may stretch it.
    ASSERT_TRUE(kept.timeLost);
    EXPECT_GT(*kept.timeLost, 0.01);
    EXPECT_NEAR(*kept.timeLost, kept.duration - closer.duration, 0.01 * closer.duration);
    EXPECT_FALSE(closer.timeLost);
  }
  // Low targets change nothing.
  const ClearanceTargets low(checker, 1e-3, overThePost().front(), overThePost().back());
  const CurveClearance lowClearance(checker, low, 0);
  EXPECT_EQ(makeTrajectory(
                problem, checker, overThePost(), TrajectoryFileKind::csv, [] { return false; },
                &lowClearance)
                .timeLost,
            0);
}

/// Where the path misses a target, the curve keeps the fraction that the path keeps.
TEST_F(MakeTrajectory, KeepsAFractionWhereThePathDoes) {
  const Problem problem = problemWith();
  const Checker checker(problem);
  const Path path{at(0, 0.2), at(0.5, 1.2), at(1.5, 1.2), at(2, 0.2)};  // 0.1 m above the post
  const ClearanceTargets targets(checker, 0.19, path.front(), path.back());
  const CurveClearance clearance(checker, targets, targets.least());
  EXPECT_EQ(clearance.fractionKept(path[0], at(0.2, 0.6)), 1);
  EXPECT_EQ(clearance.fractionKept(path[1], path[2]), 0.4);  // 0.1 / 0.19 is 0.53
  const MadeTrajectory made = makeTrajectory(
      problem, checker, path, TrajectoryFileKind::csv, [] { return false; }, &clearance);
  EXPECT_TRUE(made.isGood());
  EXPECT_FALSE(made.losesClearance);
  ASSERT_TRUE(made.clearance);
  EXPECT_LT(made.clearance->shareOnTarget, 1);
  EXPECT_GT(made.clearance->shareOnTarget, 0);
  EXPECT_GE(leastDistanceFromPost(made.curve.pieces), 0.4 * 0.19);
  // And it keeps nearly the path's clearance, if that is more.
  const CurveClearance ofPath(checker, targets, 0.099);
  const MadeTrajectory nearPath = makeTrajectory(
      problem, checker, path, TrajectoryFileKind::csv, [] { return false; }, &ofPath);
  EXPECT_GE(leastDistanceFromPost(nearPath.curve.pieces), 0.97 * 0.099);
  EXPECT_LE(made.clearance->proved, leastDistanceFromPost(made.curve.pieces));
}

/// States that differ from a neighbour by roundings cost no time.
TEST_F(MakeTrajectory, EdgesOfNearlyNothing) {
  const Problem problem = problemWith();
  const Checker checker(problem);
  const double seconds =
      makeTrajectory(problem, checker, overThePost(), TrajectoryFileKind::csv).duration;
  const double ulp = 0x1p-52;
  for (const Path& path : {Path{at(0, 0.2), at(ulp, 0.2), at(0.5, 1.3), at(1.5, 1.3), at(2, 0.2)},
                           Path{at(0, 0.2), at(0.5, 1.3), at(0.5 + ulp, 1.3), at(0.5, 1.3 + ulp),
                                at(1.5, 1.3), at(2, 0.2)},
                           Path{at(0, 0.2), at(0.5, 1.3), at(1.5, 1.3), at(2 - ulp, 0.2),
                                at(2, 0.2 + ulp), at(2, 0.2)}}) {
    const MadeTrajectory made = makeTrajectory(problem, checker, path, TrajectoryFileKind::csv);
    ASSERT_TRUE(made.isGood());
    EXPECT_EQ(verified(problem, made).verdict, PathVerdict::proved);
    EXPECT_NEAR(made.duration, seconds, 1e-6 * seconds);
  }
}

/// The edges together are longer than what counts as nothing, but lead to and fro.
TEST_F(MakeTrajectory, EdgesToAndFro) {
  const Problem problem = problemWith();
  const Checker checker(problem);
  for (const Path& path :
       {Path{at(0, 0.2), at(6e-10, 0.2), at(0, 0.2)},
        Path{at(0, 0.2), at(5e-10, 0.2), at(-5e-10, 0.2), at(5e-10, 0.2), at(1e-300, 0.2)}}) {
    const MadeTrajectory made = makeTrajectory(problem, checker, path, TrajectoryFileKind::csv);
    EXPECT_TRUE(made.isGood()) << made.fault;
    EXPECT_EQ(made.rows, 2u);
  }
}

/// Start and goal that are equal, or differ by roundings, give two rows.
TEST_F(MakeTrajectory, PathsOfNearlyNothing) {
  for (const std::string more :
       {"", "limits: {position: {velocity: 1, acceleration: 2, jerk: 9}}\n"}) {
    const Problem problem = problemWith(more);
    const Checker checker(problem);
    for (const double off : {0.0, 1e-300, 0x1p-54, 1e-12, 9e-10})
      for (const TrajectoryFileKind kind : {TrajectoryFileKind::csv, TrajectoryFileKind::message}) {
        const MadeTrajectory made =
            makeTrajectory(problem, checker, {at(0, 0.2), at(off, 0.2)}, kind);
        EXPECT_EQ(made.fault, "") << off;
        EXPECT_EQ(made.rows, 2u);
        EXPECT_TRUE(made.isGood());
        EXPECT_EQ(verified(problem, made).verdict, PathVerdict::proved);
      }
    // A little more is a path like others.
    const MadeTrajectory longer = makeTrajectory(problem, checker, {at(0, 0.2), at(1e-7, 0.2)});
    EXPECT_EQ(longer.fault, "");
    EXPECT_TRUE(longer.isGood());
  }
}

/// Stopping at every corner takes longer than rounding the corners. If no curve at a corner is
/// proved, the robot stops there.
TEST_F(MakeTrajectory, StopsOnlyWhereNoCurveIsProved) {
  const Problem problem = problemWith();
  const MadeTrajectory made = makeTrajectory(problem, Checker(problem), overThePost());
  Problem tight = problem;
  tight.settings.trajectory.cornerDeviation = 0.02;
  const MadeTrajectory slow = makeTrajectory(tight, Checker(tight), overThePost());
  EXPECT_TRUE(slow.proved());
  EXPECT_GT(slow.duration, 1.05 * made.duration);
  const MadeTrajectory stopped =
      makeTrajectory(problem, Checker(problem), overThePost(), {}, [] { return true; });
  EXPECT_EQ(stopped.rounded, 0u);
  EXPECT_TRUE(stopped.proved());
  EXPECT_GE(stopped.duration, slow.duration);
}

/// The times in a message are whole nanoseconds. Even so, dense rows keep the limits.
TEST_F(MakeTrajectory, MessagesAreAsGoodAsRows) {
  for (const char* limits :
       {"limits: {position: {velocity: 0.5, acceleration: 1, jerk: 40}}\n", ""})
    for (const double rate : {0.0, 100.0, 1000.0}) {
      Problem problem = problemWith(limits);
      if (rate > 0) problem.settings.trajectory.rate = rate;
      const Checker checker(problem);
      const MadeTrajectory rows = makeTrajectory(problem, checker, overThePost()),
                           message = makeTrajectory(problem, checker, overThePost(),
                                                    TrajectoryFileKind::message);
      EXPECT_TRUE(rows.isGood()) << limits << rate;
      EXPECT_TRUE(message.isGood()) << limits << rate;
      EXPECT_NEAR(message.duration, rows.duration, 1e-3 * rows.duration) << limits << rate;
    }
}

/// A trajectory whose whole curve is smoothed for time takes no longer than one with rounded
/// corners. That one takes no longer than one that stops at the corners.
TEST_F(MakeTrajectory, SmoothsAsTheProblemSays) {
  const auto made = [&](Smoothing smooth) {
    Problem problem = problemWith();
    problem.settings.trajectory.smooth = smooth;
    const MadeTrajectory result = makeTrajectory(problem, Checker(problem), overThePost());
    EXPECT_TRUE(result.proved()) << wordOf(smooth);
    EXPECT_EQ(verified(problem, result).verdict, PathVerdict::proved) << wordOf(smooth);
    return result;
  };
  const MadeTrajectory none = made(Smoothing::none), corners = made(Smoothing::corners),
                       time = made(Smoothing::time);
  EXPECT_EQ(none.curveTests, 0u);
  EXPECT_EQ(none.rounded, 0u);
  EXPECT_EQ(corners.rounded, 2u);
  EXPECT_EQ(corners.replaced, 0u);
  EXPECT_GT(time.replaced, 0u);
  EXPECT_LT(corners.duration, none.duration);
  EXPECT_LT(time.duration, corners.duration);
  made(Smoothing::length);
  made(Smoothing::acceleration);
}

/// Corners that are rounded by a micrometre can't take longer than stops at them.
TEST_F(MakeTrajectory, TinyCornersAreNotSlowerThanStops) {
  for (const char* limits : {"", "limits: {position: {jerk: 5}, rotation: {jerk: 5}}\n"}) {
    const Problem problem = problemWith(limits);
    const Checker checker(problem);
    const MadeTrajectory stopped =
        makeTrajectory(problem, checker, overThePost(), {}, [] { return true; });
    for (const double deviation : {1e-7, 1e-6, 1e-4}) {
      Problem tiny = problem;
      tiny.settings.trajectory.cornerDeviation = deviation;
      const MadeTrajectory made = makeTrajectory(tiny, checker, overThePost());
      EXPECT_TRUE(made.isGood()) << limits << deviation;
      EXPECT_LE(made.duration, stopped.duration) << limits << deviation;
    }
  }
}

TEST_F(MakeTrajectory, KeepsJerkRateAndScale) {
  const Problem problem = problemWith(
      "limits: {position: {velocity: 0.5, acceleration: 1, jerk: 4}}\n"
      "trajectory: {rate: 50}\n");
  const MadeTrajectory made = makeTrajectory(problem, Checker(problem), overThePost());
  EXPECT_EQ(made.fault, "");
  EXPECT_TRUE(made.proved());
  EXPECT_EQ(made.between, RowInterpolation::quintic);
  EXPECT_GT(made.ratios.jerk.share, 0);
  EXPECT_TRUE(keepsLimits(made.ratios));
  EXPECT_GE(made.rows, 50 * made.duration);
  EXPECT_LE(made.ratios.velocity.share, 1);
}

/// The curve of the rows dips for less than a millisecond: by 10^-6 m into the floor, or to a
/// height of 10^-6 m above the floor. The two files differ in exactly one row.
TEST_F(MakeTrajectory, AClipOfAMicrometreIsFound) {
  const Problem problem = problemWith();
  const Checker checker(problem);
  for (const double gap : {1e-6, -1e-6}) {
    // At the dip, the bottom of the square (y − 0.1) is `gap` above the floor.
    std::string text = "time,x,y,yaw,x_velocity,y_velocity,yaw_velocity\n";
    for (int k = 0; k <= 10; ++k) {
      const double y = k == 6 ? 0.1 + gap : 0.2;
      std::ostringstream line;
      line.precision(17);
      line << 0.1 * k << ',' << 0.05 * k << ',' << y << ",0,0.5,0,0\n";
      text += line.str();
    }
    const TrajectoryRows rows = readTrajectory("clip.csv", text, problem.model);
    const VerifyReport report = verifyTrajectory(problem, rows);
    const Curve curve = curveOf(rows, problem.model.space, RowInterpolation::cubic);
    std::size_t touching = 0;
    for (const CurvePiece& piece : curve.pieces)
      touching += checker.certifyCurve(piece).verdict == MotionVerdict::contact;
    if (gap > 0) {
      EXPECT_EQ(report.verdict, PathVerdict::proved);
      EXPECT_EQ(touching, 0u);
      continue;
    }
    EXPECT_GT(touching, 0u);
    EXPECT_EQ(report.verdict, PathVerdict::refuted);
    ASSERT_FALSE(report.pathReport.findings.empty());
    const PathFinding& first = report.pathReport.findings.front();
    EXPECT_EQ(first.edge, 5);
    // y − 0.1 ≈ −10^-6 + 3·0.1·(Δt/0.1)²: below 0 for 0.18 ms before the row.
    EXPECT_GT(first.t, 1 - 0.0021);
    EXPECT_TRUE(first.a == "floor" || first.b == "floor") << first.a << ' ' << first.b;
  }
}

/// The curve between rows of a spline that overshoots is refuted, although every row is free.
TEST_F(MakeTrajectory, RowsThatAreFreeDoNotSuffice) {
  const Problem problem = problemWith();
  const std::string text =
      "time,x,y,yaw,x_velocity,y_velocity,yaw_velocity\n"
      "0,0,0.3,0,0,-2,0\n1,0.2,0.3,0,0,2,0\n";
  const VerifyReport report =
      verifyTrajectory(problem, readTrajectory("spline.csv", text, problem.model));
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  ASSERT_TRUE(report.limits);
  EXPECT_FALSE(keepsLimits(*report.limits));  // 4 m/s² at the rows, and 1 m/s² is assumed
}

}  // namespace
}  // namespace corridor
