// Tests of the planners SlidingConnect and Portfolio, and of the steps along obstacles: a square
// that has to pass a slot of nearly its own width.
#include "planner/solve/sliding_connect.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ompl/base/PlannerData.h>
#include <ompl/base/spaces/SE2StateSpace.h>

#include "planner/checker/motion_validators.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/problem/problem.h"
#include "planner/solve/contact_step.h"
#include "planner/solve/portfolio.h"
#include "planner/solve/solve.h"
#include "planner/solve/verify_solution.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

namespace ob = ompl::base;
using test::boxMesh;
using test::meshShape;
using test::partShape;
using test::poseOf;
using test::Rigid;

/// Returns a problem of a square with sides of 1 m, and a wall 2 m thick with a slot that is wider
/// by `play`.
Problem slotProblem(double play) {
  Problem problem = test::rigidProblem(Rigid::SE2);
  const double half = (1 + play) / 2;
  problem.model.bodies = {
      {"square", 2, 0, {meshShape("square", boxMesh({1, 1, 1}))}},
      {"upper", 0, {}, {meshShape("upper", boxMesh({2, 4, 1}, {0, half + 2, 0}))}},
      {"lower", 0, {}, {meshShape("lower", boxMesh({2, 4, 1}, {0, -half - 2, 0}))}}};
  problem.task.start = poseOf(Rigid::SE2, -3, 3, 1);
  problem.task.goals = {poseOf(Rigid::SE2, 3, -3, -2)};
  problem.settings.planner.name = "SlidingConnect";
  problem.settings.planner.time = 60 * test::kSlowdown;  // a limit; the searches end earlier
  problem.settings.simplify = Simplifier::none;
  return problem;
}

/// Returns the median of the edges that five seeds need.
std::uint64_t medianEdges(Problem problem) {
  std::vector<std::uint64_t> edges;
  for (problem.settings.seed = 1; problem.settings.seed <= 5; ++problem.settings.seed) {
    const SolveReport report = solveProblem(problem);
    EXPECT_EQ(report.outcome, SolveOutcome::solved) << report.why;
    edges.push_back(report.counters.edges);
  }
  std::sort(edges.begin(), edges.end());
  return edges[2];
}

TEST(SlidingConnect, EntersNarrowTubesWithFewerEdges) {
  Problem problem =
      readProblem(std::string(CORRIDOR_SOURCE_DIR) + "/problems/twisted_tubes/problem.yaml");
  problem.settings.simplify = Simplifier::none;
  const std::uint64_t plain = medianEdges(problem);
  problem.settings.planner.name = "SlidingConnect";
  problem.settings.planner.params.clear();
  EXPECT_LT(medianEdges(problem), plain);  // measured: 8,137 and 24,357
}

TEST(SlidingConnect, PathsAreProvedAndRepeat) {
  for (const double margin : {0.0, 0.02}) {
    Problem problem = slotProblem(0.1);
    problem.task.margin = margin;
    problem.task.padding.bodies = {{0, 0.5 * margin}};
    problem.settings.simplify = Simplifier::corridor;
    const SolveReport report = solveProblem(problem);
    ASSERT_EQ(report.outcome, SolveOutcome::solved) << report.why;
    EXPECT_TRUE(report.certified);
    EXPECT_TRUE(report.repeatable);
    EXPECT_EQ(verifySolution(problem, makeSolution(problem, report)).verdict, PathVerdict::proved);
    EXPECT_EQ(solveProblem(problem).path, report.path);
    problem.settings.seed = 2;
    EXPECT_NE(solveProblem(problem).path, report.path);
  }
}

/// Checkers around Corridor's, such as those that `benchmark` measures times with, change nothing.
/// With other checkers, such as FCL, nothing slides.
TEST(SlidingConnect, SlidesIfTheTestsAreTheCheckers) {
  Problem problem = slotProblem(0.1);
  SolveOptions options;
  options.adaptChecking = [](const ob::SpaceInformationPtr& si, const Checker& checker) {
    si->setStateValidityChecker([si, &checker](const ob::State* state) {
      return checker.isProvedFree(configurationOf(*si, state));
    });
  };
  options.adaptedTestsAreProofs = true;
  const SolveReport own = solveProblem(problem), around = solveProblem(problem, options);
  ASSERT_EQ(own.outcome, SolveOutcome::solved) << own.why;
  EXPECT_EQ(around.path, own.path);
  options.adaptedTestsAreProofs = false;
  const SolveReport other = solveProblem(problem, options);
  problem.settings.planner.params = {{"slides", "0"}, {"turn_weight", "0"}};
  EXPECT_EQ(other.path, solveProblem(problem).path);
  EXPECT_NE(other.path, own.path);
  EXPECT_THROW(
      SlidingConnect(std::make_shared<ob::SpaceInformation>(std::make_shared<ob::SE2StateSpace>()),
                     nullptr),
      std::invalid_argument);
}

TEST(SlidingConnect, WorksWithSampledEdges) {
  Problem problem = slotProblem(1);
  problem.settings.checker.edges = EdgeMethod::discrete;
  EXPECT_EQ(solveProblem(problem).outcome, SolveOutcome::solved);
}

TEST(SlidingConnect, ItsTreesAreEdgesThatAreFree) {
  const Problem problem = slotProblem(0.005);
  const Checker checker(problem);
  const auto space = std::make_shared<ProblemStateSpace>(problem.model.space);
  const auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker(std::make_shared<CertifiedStateValidityChecker>(si, checker));
  si->setMotionValidator(std::make_shared<CertifiedMotionValidator>(si, checker));
  si->setup();
  ob::ScopedState<> start(si), goal(si);
  space->write(problem.task.start, start.get());
  space->write(problem.task.goals[0], goal.get());
  const auto definition = std::make_shared<ob::ProblemDefinition>(si);
  definition->setStartAndGoalStates(start, goal);
  SlidingConnect planner(si, &checker);
  planner.setProblemDefinition(definition);
  planner.setup();
  int rounds = 0;
  ASSERT_EQ(planner.solve(ob::PlannerTerminationCondition([&] { return ++rounds > 100; })),
            ob::PlannerStatus::TIMEOUT)
      << "the case is too easy";
  ob::PlannerData data(si);
  planner.getPlannerData(data);
  EXPECT_EQ(data.numStartVertices(), 1U);
  EXPECT_EQ(data.numGoalVertices(), 1U);
  ASSERT_GT(data.numVertices(), 100U);
  EXPECT_EQ(data.numEdges(), data.numVertices() - 2);
  for (unsigned from = 0; from < data.numVertices(); ++from) {
    std::vector<unsigned> next;
    data.getEdges(from, next);
    for (const unsigned to : next)
      EXPECT_TRUE(checker.isProvedFree(configurationOf(*si, data.getVertex(from).getState()),
                                       configurationOf(*si, data.getVertex(to).getState())));
  }
}

/// A ball's distance from a ball has a closed form, and so has its gradient.
TEST(ContactStep, GradientsOfDistances) {
  Problem problem = test::rigidProblem(Rigid::SE2);
  problem.model.bodies = {{"ball", 2, 0, {partShape("ball", Sphere{0.5}, {1, 0, 0})}},
                          {"post", 0, {}, {partShape("post", Sphere{0.3}, {2, 1, 0})}}};
  const Checker checker(problem);
  std::mt19937_64 random(test::testSeed(5701));
  std::uniform_real_distribution<double> in(-1, 1);
  for (int n = 0; n < 50; ++n) {
    const Configuration q = poseOf(Rigid::SE2, in(random)-1, in(random)-1, 3 * in(random));
    const Eigen::Vector2d arm(std::cos(q[2]), std::sin(q[2])), ball = q.head<2>() + arm,
                                                               apart = ball - Eigen::Vector2d(2, 1);
    const auto near = checker.pairsWithin(q, PairMargins({10.0}));
    ASSERT_EQ(near.size(), 1U);
    const std::vector<DistanceConstraint> all =
        constraintsOf(checker, near, q, tangentWeights(checker.space()));
    ASSERT_EQ(all.size(), 1U);
    const Eigen::Vector2d away = apart.normalized();
    const Eigen::Vector3d gradient(away.x(), away.y(),
                                   away.dot(Eigen::Vector2d(-arm.y(), arm.x())));
    EXPECT_LT((all[0].gradient - gradient).norm(), 1e-5);
    EXPECT_NEAR(all[0].distance, apart.norm() - 0.8, 1e-3 * apart.norm());
    EXPECT_NEAR(all[0].change, all[0].gradient.dot(all[0].step), 1e-12);
  }
}

DistanceConstraint along(const TangentStep& gradient, double need) {
  DistanceConstraint c;
  c.gradient = c.step = gradient;
  c.change = gradient.squaredNorm();
  c.need = need;
  return c;
}

TEST(ContactStep, ShortestStepsMeetAllConstraints) {
  const TangentStep x = TangentStep::Unit(3, 0), y = TangentStep::Unit(3, 1);
  std::vector<DistanceConstraint> corner{along(x, 1), along(y, 2), along(x + y, 2.5)};
  ASSERT_TRUE(shortestStep(corner, 3));
  EXPECT_LT((*shortestStep(corner, 3) - TangentStep(x + 2 * y)).norm(), 1e-9);
  std::vector<DistanceConstraint> free{along(x, -1)};  // the step may lose up to 1
  EXPECT_EQ(*shortestStep(free, 3), TangentStep(TangentStep::Zero(3)));
  std::vector<DistanceConstraint> narrow{along(x, 1), along(-x, 1)};
  EXPECT_FALSE(shortestStep(narrow, 3));
}

TEST(Portfolio, LubysSequence) {
  std::vector<std::uint64_t> first;
  for (std::uint64_t i = 1; i <= 15; ++i) first.push_back(luby(i));
  EXPECT_THAT(first, testing::ElementsAre(1, 1, 2, 1, 1, 2, 4, 1, 1, 2, 1, 1, 2, 4, 8));
}

/// Easy problems are solved by its first search, which is RRTConnect's.
TEST(Portfolio, BeginsLikeRrtConnect) {
  Problem problem = test::armProblem();
  problem.settings.planner.name = "RRTConnect";
  const SolveReport alone = solveProblem(problem);
  problem.settings.planner.name = "Portfolio";
  const SolveReport first = solveProblem(problem);
  ASSERT_EQ(first.outcome, SolveOutcome::solved);
  EXPECT_EQ(first.path, alone.path);
  EXPECT_EQ(first.counters.edges, alone.counters.edges);
}

TEST(Portfolio, SolvesWhatRrtConnectDoesNot) {
  Problem problem = slotProblem(0.1);
  problem.settings.planner.name = "Portfolio";
  const SolveReport report = solveProblem(problem);
  ASSERT_EQ(report.outcome, SolveOutcome::solved) << report.why;
  EXPECT_TRUE(report.repeatable);
  EXPECT_GT(report.counters.edges, 2000U) << "more than the first search";
  EXPECT_EQ(verifySolution(problem, makeSolution(problem, report)).verdict, PathVerdict::proved);
  EXPECT_EQ(solveProblem(problem).path, report.path);
}

}  // namespace
}  // namespace corridor
