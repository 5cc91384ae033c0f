// Tests of `solveProblem` for an arm: planners, the default range, restarts, several goals, and
// goal regions.
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/solve/solve.h"
#include "planner/solve/verify_solution.h"
#include "tests/planner/checker/hall.h"
#include "tests/planner/solve/complaint.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::armProblem;
using test::complaintOf;
using testing::HasSubstr;
using testing::StartsWith;

Problem armAt(double shoulder, double elbow, double wrist) {
  Problem problem = armProblem();
  problem.task.start = Vec3(shoulder, elbow, wrist);
  return problem;
}

TEST(Arm, EveryKindOfPlannerSolvesCertifiedAndVerified) {
  Problem problem = armProblem();
  problem.settings.planner.stopAtFirst = true;
  problem.settings.planner.time = 10 * test::kSlowdown;  // a limit; planners end earlier
  for (const char* planner :
       {"RRTConnect", "RRT", "KPIECE1", "SBL", "PRM", "RRTstar", "InformedRRTstar", "BITstar"}) {
    problem.settings.planner.name = planner;
    const SolveReport report = solveProblem(problem);
    ASSERT_EQ(report.outcome, SolveOutcome::solved) << planner << ": " << report.why;
    EXPECT_TRUE(report.certified);
    EXPECT_EQ(report.length.metres, 0);
    EXPECT_GE(report.length.radians, 2.8 - 1e-12);
    EXPECT_EQ(verifySolution(problem, makeSolution(problem, report)).verdict, PathVerdict::proved)
        << planner;
  }
}

TEST(Arm, DefaultRangeIsAShareOfARevolution) {
  Problem problem = armProblem();
  problem.settings.simplify = Simplifier::none;
  problem.settings.planner.stopAtFirst = true;
  const auto path = [&](const char* range) {
    problem.settings.planner.params.clear();
    if (range) problem.settings.planner.params = {{"range", range}};
    return solveProblem(problem).path;
  };
  const Path own = path(nullptr);
  ASSERT_FALSE(own.empty());
  for (std::size_t i = 0; i + 1 < own.size(); ++i)
    EXPECT_LE(problem.model.space.distance(own[i], own[i + 1]), 0.7 * (1 + 1e-12));
  EXPECT_EQ(own, path("0.7"));
  EXPECT_NE(own, path("0"));
}

/// A search that starts again often still finds a path, counts its restarts, and gives the same
/// path with the same seed.
TEST(Arm, SearchesStartAgainAfterTooManyEdges) {
  Problem problem = armProblem();
  problem.settings.planner.name = "RRT";
  EXPECT_EQ(solveProblem(problem).restarts, 0U);
  problem.settings.planner.restart = 1;
  const SolveReport report = solveProblem(problem);
  ASSERT_EQ(report.outcome, SolveOutcome::solved) << report.why;
  EXPECT_GT(report.restarts, 1U);
  EXPECT_TRUE(report.repeatable);
  EXPECT_EQ(solveProblem(problem).path, report.path);
  EXPECT_EQ(verifySolution(problem, makeSolution(problem, report)).verdict, PathVerdict::proved);
  problem.settings.planner.name = "RRTstar";  // with stop: time, it uses all its time
  problem.settings.planner.stopAtFirst = false;
  problem.settings.planner.time = 0.5;
  const SolveReport optimised = solveProblem(problem);
  EXPECT_EQ(optimised.restarts, 0U);
  EXPECT_GE(optimised.planningTime, 0.5);
  problem.settings.planner = PlannerSettings();
  problem.settings.planner.name = "RRT";
  problem.settings.planner.restart = 0;
  EXPECT_EQ(solveProblem(problem).restarts, 0U);
}

TEST(Arm, OneFreeGoalOfSeveralIsEnoughAndTheOthersAreReported) {
  Problem problem = armProblem();
  problem.task.goals = {Vec3(std::numbers::pi / 4, 0, 0), Vec3(2, -0.5, 0.3), Vec3(-2, 0, 0)};
  const SolveReport report = solveProblem(problem);
  ASSERT_EQ(report.outcome, SolveOutcome::solved) << report.why;
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_THAT(report.warnings[0].str(),
              StartsWith("arm.yaml:5: goal 1 of 3: in contact: \"lower\" and \"post\" touch; the "
                         "nearest free values found are at most "));
  EXPECT_TRUE(report.path.back() == problem.task.goals[1] ||
              report.path.back() == problem.task.goals[2]);
  EXPECT_EQ(verifySolution(problem, makeSolution(problem, report)).verdict, PathVerdict::proved);
  problem.task.goals.resize(1);
  EXPECT_THAT(complaintOf(problem), StartsWith("arm.yaml:5: goal: in contact: "));
}

TEST(Arm, GoalRegionOfJoints) {
  Problem problem = armProblem();
  problem.task.goalRegion = GoalRegion{0, 0, 0.1};
  problem.task.goals = {Vec3(std::numbers::pi, 1.6, 0.3)};  // the region crosses the shoulder's ±π
  problem.settings.planner.name = "RRT";
  const SolveReport report = solveProblem(problem);
  ASSERT_EQ(report.outcome, SolveOutcome::solved) << report.why;
  EXPECT_EQ(verifySolution(problem, makeSolution(problem, report)).verdict, PathVerdict::proved);
}

TEST(Arm, StartInSelfContactNamesTheLinks) {
  EXPECT_THAT(complaintOf(armAt(0, 2.45, 2.45)),
              StartsWith("arm.yaml:4: start: in contact: \"upper\" and \"hand\" (shape "));
  EXPECT_EQ(complaintOf(armAt(0, 3, 0)), "arm.yaml:4: start: elbow = 3 is not in [-2.5, 2.5]");
}

}  // namespace
}  // namespace corridor
