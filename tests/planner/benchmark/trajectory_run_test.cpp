// Tests of the trajectories of benchmark runs: all makers along one path, and the figures of
// trajectories as rows.
#include "planner/benchmark/trajectory_run.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/benchmark/rows.h"
#include "planner/benchmark/run_record.h"
#include "planner/benchmark/trajectory_rows.h"
#include "planner/trajectory/natural_spline.h"
#include "tests/planner/problem/problem_fixture.h"

namespace corridor {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A square of 0.2 m in the plane goes along a floor whose top is at y = 0, and then up. A spline
/// through the corner dips below the first edge, into the floor.
class TrajectoryRuns : public test::SquareTest {
 protected:
  Problem problemWith(const std::string& more = "") const {
    return read(
        "format: corridor-problem-1\nrobot: square.yaml\nworld:\n"
        "  floor: {box: [10, 1, 1], at: [0, -0.5, 0]}\n"
        "start: {at: [0, 0.11]}\ngoal: {at: [1, 1.11]}\nbounds: {at: [[-3, -3], [5, 5]]}\n" +
        more);
  }
  static Path corner() { return {at(0, 0.11), at(1, 0.11), at(1, 1.11)}; }
  static TrajectoryRun runOf(TrajectoryMaker maker, const Problem& problem) {
    return runTrajectory(maker, problem, Checker(problem), corner());
  }
};

TEST_F(TrajectoryRuns, EveryMaker) {
  const Problem problem = problemWith();
  const TrajectoryRun blends = runOf(TrajectoryMaker::blends, problem),
                      stop = runOf(TrajectoryMaker::stop, problem),
                      spline = runOf(TrajectoryMaker::spline, problem),
                      inserted = runOf(TrajectoryMaker::inserted, problem);
  for (const TrajectoryRun* run : {&blends, &stop, &spline, &inserted}) {
    EXPECT_EQ(run->fault, "");
    EXPECT_GE(run->rows, 2u);
    EXPECT_GT(run->duration, 0);
    EXPECT_GT(run->makeTime, 0);
    EXPECT_GT(run->verifyTime, 0);
    EXPECT_EQ(run->velocity, -1);  // no limit is given
    EXPECT_GT(run->acceleration, 0.99);
    EXPECT_LE(run->acceleration, 1 + kLimitSlack);
    EXPECT_EQ(run->jerk, -1);
    EXPECT_EQ(run->link, -1);
    EXPECT_EQ(run->beyondBounds, 0);
  }
  EXPECT_EQ(blends.verdict, "proved");
  EXPECT_EQ(stop.verdict, "proved");
  EXPECT_EQ(blends.finding, "");
  // Each edge is 1 m long. From rest to rest with 1 m/s², it takes 2 s.
  EXPECT_NEAR(stop.duration, 4, 1e-3);
  EXPECT_LT(blends.duration, 0.97 * stop.duration);
  // If the robot need not stop at the corner, its speed there is √2 m/s, and each edge takes √2 s.
  EXPECT_NEAR(optimumAlong(problem, corner()), 2 * std::sqrt(2), 0.01 * 2 * std::sqrt(2));
  // The spline dips by more than 1 cm. By its definition, the second derivative at the corner is m
  // = 6·(−1, 1)/4. On the first edge, of length h, y − 0.11 = −(h²/6)·m_y·(τ − τ³), whose least
  // value is −0.096.
  EXPECT_EQ(spline.verdict, "refuted");
  EXPECT_THAT(spline.finding, HasSubstr("contact"));
  EXPECT_THAT(spline.finding, HasSubstr("floor"));
  EXPECT_THAT(spline.finding, HasSubstr(" s: "));
  // After states were inserted, no sample touches. Only the verifier decides about the curve
  // between the samples.
  const Checker checker(problem);
  const InsertedSpline states = insertedSpline(problem.model.space, corner(), [&](const auto& q) {
    return checker.interference(q).has_value();
  });
  EXPECT_GT(states.inserted, 0u);
  EXPECT_FALSE(states.touches);
  EXPECT_GT(inserted.rows, spline.rows);
}

TEST_F(TrajectoryRuns, JerkVelocityAndBounds) {
  const Problem problem =
      problemWith("limits: {position: {velocity: 0.5, acceleration: 1, jerk: 20}}\n");
  for (const TrajectoryMaker maker : {TrajectoryMaker::blends, TrajectoryMaker::stop,
                                      TrajectoryMaker::spline, TrajectoryMaker::inserted}) {
    const TrajectoryRun run = runOf(maker, problem);
    EXPECT_EQ(run.fault, "") << nameOf(maker);
    EXPECT_GT(run.velocity, 0.9) << nameOf(maker);
    for (const double share : {run.velocity, run.acceleration, run.jerk}) {
      EXPECT_GT(share, 0) << nameOf(maker);
      EXPECT_LE(share, 1 + kLimitSlack) << nameOf(maker);
    }
  }
  // A spline that leaves the bounds is refuted, although nothing is there.
  Problem narrow = read(
      "format: corridor-problem-1\nrobot: square.yaml\nworld: {far: {sphere: 0.1, at: [4, 4, 0]}}\n"
      "start: {at: [0, 0.11]}\ngoal: {at: [1, 1.11]}\nbounds: {at: [[-3, 0.1], [5, 5]]}\n");
  const TrajectoryRun run = runOf(TrajectoryMaker::spline, narrow);
  EXPECT_EQ(run.verdict, "refuted");
  EXPECT_THAT(run.finding, HasSubstr("y = "));
  EXPECT_NEAR(run.beyondBounds, 1.5 / 6 * 2 / std::sqrt(27) - 0.01, 1e-3);
}

TEST_F(TrajectoryRuns, NoSplineOfRotations) {
  write("cube.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE3\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
  const Problem problem = read(
      "format: corridor-problem-1\nrobot: cube.yaml\nworld: {far: {sphere: 0.1, at: [4, 4, "
      "0]}}\nstart: {at: [0, 0, 0]}\ngoal: {at: [1, 0, "
      "0], rpy_deg: [0, 0, 90]}\nbounds: {at: [[-3, -3, -3], [5, 5, 5]]}\n");
  const Path path{problem.task.start, problem.task.goals[0]};
  const Checker checker(problem);
  for (const TrajectoryMaker maker : {TrajectoryMaker::spline, TrajectoryMaker::inserted}) {
    const TrajectoryRun run = runTrajectory(maker, problem, checker, path);
    EXPECT_THAT(run.fault, HasSubstr("splines of quaternions are not rotations"));
    EXPECT_EQ(run.verdict, "");
  }
  for (const TrajectoryMaker maker : {TrajectoryMaker::blends, TrajectoryMaker::stop})
    EXPECT_EQ(runTrajectory(maker, problem, checker, path).verdict, "proved");
}

TEST_F(TrajectoryRuns, ThePathMustMove) {
  const Problem problem = problemWith();
  const Checker checker(problem);
  for (const TrajectoryMaker maker : {TrajectoryMaker::blends, TrajectoryMaker::stop,
                                      TrajectoryMaker::spline, TrajectoryMaker::inserted})
    for (const Path& path : {Path{at(0, 0.11)}, Path{at(0, 0.11), at(0, 0.11)}}) {
      const TrajectoryRun run = runTrajectory(maker, problem, checker, path);
      EXPECT_NE(run.fault, "") << nameOf(maker);
      EXPECT_EQ(run.verdict, "");
      EXPECT_TRUE(std::isnan(optimumAlong(problem, path)));
    }
}

/// A campaign with two sets of limits and two makers, with figures instead of real runs.
class TrajectoryFigures : public testing::Test {
 protected:
  TrajectoryFigures() {
    campaign_.problems.resize(1);
    campaign_.problemNames = {"p"};
    campaign_.variants = {readVariant("certified")};
    campaign_.trajectories.makers = {TrajectoryMaker::stop, TrajectoryMaker::spline};
    campaign_.trajectories.limits = {{"own", {{}}}, {"fast", {{}}}};
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      BenchmarkRun run;
      run.seed = seed;
      run.solved = seed < 4;
      run.result = run.solved ? "solved" : "not found";
      run.verdict = !run.solved ? "" : seed == 3 ? "refuted" : "proved";
      if (run.solved)
        for (const double factor : {1.0, 0.5}) {
          const double s = factor * static_cast<double>(seed);
          TrajectoryRun stop, spline;
          stop.duration = 4 * s, stop.rows = 5, stop.verdict = run.verdict, stop.velocity = 0.5;
          spline.duration = 2.5 * s, spline.rows = 9, spline.jerk = 0.1 * s;
          spline.verdict = seed == 2 ? "proved" : "refuted";
          spline.finding = seed == 2 ? "" : "touches";
          if (factor < 1 && seed == 2) spline = {}, spline.fault = "no spline";
          run.trajectories.push_back({2 * s, {stop, spline}});
        }
      cell_.runs.push_back(run);
    }
  }
  static RowValue value(const Row& row, const std::string& name) {
    for (const auto& [column, held] : row)
      if (column == name) return held;
    return RowValue{"no such column"};
  }

  Campaign campaign_;
  CampaignCell cell_{0, 0, {"RRT", "RRT", {}}, {}};
};

TEST_F(TrajectoryFigures, RowsOfRuns) {
  const Row first = runRow(campaign_, cell_, cell_.runs[0]);
  EXPECT_EQ(value(first, "own_optimum_s"), RowValue{2.0});
  EXPECT_EQ(value(first, "fast_optimum_s"), RowValue{1.0});
  EXPECT_EQ(value(first, "own_stop_duration_s"), RowValue{4.0});
  EXPECT_EQ(value(first, "own_stop_velocity"), RowValue{0.5});
  EXPECT_EQ(value(first, "own_stop_jerk"), RowValue{});
  EXPECT_EQ(value(first, "own_spline_verdict"), RowValue{"refuted"});
  EXPECT_EQ(value(first, "own_spline_finding"), RowValue{"touches"});
  EXPECT_EQ(value(first, "own_spline_rows"), RowValue{std::uint64_t{9}});
  const Row second = runRow(campaign_, cell_, cell_.runs[1]);
  EXPECT_EQ(value(second, "fast_spline_verdict"), RowValue{});
  EXPECT_EQ(value(second, "fast_spline_duration_s"), RowValue{});
  EXPECT_EQ(value(second, "fast_spline_finding"), RowValue{"no spline"});
  // A run without a path has the same columns, without values.
  const Row last = runRow(campaign_, cell_, cell_.runs[3]);
  ASSERT_EQ(last.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(last[i].first, first[i].first);
  EXPECT_EQ(value(last, "own_stop_verdict"), RowValue{});
}

TEST_F(TrajectoryFigures, SummaryAndTotals) {
  const Row row = summaryRow(campaign_, cell_);
  EXPECT_EQ(value(row, "own_spline_made"), RowValue{std::uint64_t{3}});
  EXPECT_EQ(value(row, "own_spline_refuted"), RowValue{std::uint64_t{2}});
  EXPECT_EQ(value(row, "own_spline_refuted_of_proved"), RowValue{std::uint64_t{1}});
  EXPECT_EQ(value(row, "fast_spline_made"), RowValue{std::uint64_t{2}});
  EXPECT_EQ(value(row, "fast_spline_proved"), RowValue{std::uint64_t{0}});
  EXPECT_EQ(value(row, "own_stop_refuted"), RowValue{std::uint64_t{1}});
  EXPECT_EQ(value(row, "own_stop_duration_s"), RowValue{8.0});
  EXPECT_EQ(value(row, "own_stop_velocity"), RowValue{0.5});
  EXPECT_EQ(value(row, "own_stop_jerk"), RowValue{});
  EXPECT_NEAR(std::get<double>(value(row, "own_spline_over_optimum")), 1.25, 1e-12);
  EXPECT_NEAR(std::get<double>(value(row, "own_spline_saved")), 0.75, 1e-12);
  EXPECT_NEAR(std::get<double>(value(row, "own_spline_jerk")), 0.3, 1e-12);  // the largest
  const std::vector<Row> totals = trajectoryRows(campaign_, {cell_});
  ASSERT_EQ(totals.size(), 4u);
  EXPECT_EQ(value(totals[3], "limits"), RowValue{"fast"});
  EXPECT_EQ(value(totals[3], "trajectory"), RowValue{"spline"});
  EXPECT_EQ(value(totals[3], "refuted"), RowValue{std::uint64_t{2}});
  const TrajectoryScore score = scoreOf(campaign_, {cell_}, 0, 0, 1);
  EXPECT_EQ(score.paths, 3u);
  EXPECT_EQ(score.provedPaths, 2u);
  EXPECT_EQ(score.refutedShare.from, shareInterval(2, 3).from);
  // Without trajectories, nothing is added.
  campaign_.trajectories = {};
  EXPECT_EQ(csvOf(std::vector<Row>{summaryRow(campaign_, cell_)}),
            csvOf(std::vector<Row>{pathSummaryRow(campaign_, cell_)}));
  EXPECT_THAT(csvOf(std::vector<Row>{runRow(campaign_, cell_, cell_.runs[0])}),
              Not(HasSubstr("stop")));
}

/// Runs are stored as text. The text of a run without trajectories is the same as in versions that
/// had no trajectories.
TEST_F(TrajectoryFigures, RunsAreStoredAsText) {
  const BenchmarkRun read = readRun(text(cell_.runs[0]));
  EXPECT_EQ(text(read), text(cell_.runs[0]));
  ASSERT_EQ(read.trajectories.size(), 2u);
  EXPECT_EQ(read.trajectories[1].makers[1].duration, 1.25);
  BenchmarkRun without = cell_.runs[0];
  without.trajectories.clear();
  EXPECT_THAT(text(without), Not(HasSubstr("trajectories")));
  EXPECT_TRUE(readRun(text(without)).trajectories.empty());
}

}  // namespace
}  // namespace corridor
