// Tests of padding, the distances that single bodies and pairs must keep, with two balls at known
// distances from a path.
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/checker/fixed_pairs.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/solve/solve.h"
#include "planner/solve/verify_solution.h"
#include "planner/solve/why_not_free.h"
#include "tests/planner/checker/hall.h"
#include "tests/planner/solve/plane_curves.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::partShape;
using test::poseOf;
using test::Rigid;
using testing::HasSubstr;

/// Returns a problem: a ball of radius 0.5 m (body 0) moves along y = 0. The obstacle "low" (body
/// 1) is 0.1 m from the moving ball where they are closest, "high" (body 2) is 0.2 m from it.
Problem twoBalls() {
  Problem problem = test::rigidProblem(Rigid::SE2);
  problem.source.name = "balls";
  problem.model.bodies = {{"ball", 2, 0, {partShape("ball", Sphere{0.5})}},
                          {"low", 0, {}, {partShape("low", Sphere{0.3}, {0, -0.9, 0})}},
                          {"high", 0, {}, {partShape("high", Sphere{0.3}, {0, 1, 0})}}};
  problem.task.start = poseOf(Rigid::SE2, -3, 0);
  problem.task.goals = {poseOf(Rigid::SE2, 3, 0)};
  return problem;
}

bool isFree(const Problem& problem) {
  return Checker(problem).isProvedFree(problem.task.start, problem.task.goals[0]);
}
PathVerdict verdictOf(const Problem& problem) {
  return verifyPath(plainProblem(problem), {problem.task.start, problem.task.goals[0]}).verdict;
}

TEST(Padding, IsAddedForEachPair) {
  const double little = 1e-5;
  struct Case {
    Padding padding;
    double margin;
    bool free;
  };
  for (const auto& [padding, margin, free] : std::vector<Case>{
           {{}, 0.1 - little, true},
           {{}, 0.1 + little, false},
           {{{{0, 0.1 - little}}, {}}, 0, true},  // padding of the moving body
           {{{{0, 0.1 + little}}, {}}, 0, false},
           {{{{2, 0.2 - little}}, {}}, 0, true},  // padding of one obstacle
           {{{{2, 0.2 + little}}, {}}, 0, false},
           {{{{0, 0.05}, {1, 0.05 - little}}, {}}, 0, true},  // padding of both bodies
           {{{{0, 0.05}, {1, 0.05 + little}}, {}}, 0, false},
           {{{{2, 0.15}}, {}}, 0.05 - little, true},  // padding and margin add up
           {{{{2, 0.15}}, {}}, 0.05 + little, false},
           {{{}, {{{0, 2}, 0.2 - little}}}, 0, true},  // padding of a pair
           {{{}, {{{0, 2}, 0.2 + little}}}, 0, false},
           {{{{0, 0.15}}, {{{0, 1}, 0.01}}}, 0, true},  // a pair's padding replaces the bodies'
           {{{{0, 0.25}}, {{{0, 1}, 0.01}}}, 0, false}}) {
    Problem problem = twoBalls();
    problem.task.padding = padding;
    problem.task.margin = margin;
    EXPECT_EQ(isFree(problem), free);
    EXPECT_EQ(verdictOf(problem), free ? PathVerdict::proved : PathVerdict::refuted);
  }
}

/// Two balls of one robot slide along x, the second one twice as far: their distance grows from
/// 0.1 m. An obstacle is 0.2 m from the ways of both.
TEST(Margins, DifferForLinksAndObstacles) {
  const double little = 1e-5;
  struct Case {
    MarginsBeyond beyond;
    double margin;
    bool free;
  };
  for (const auto& [beyond, margin, free] :
       std::vector<Case>{{{0, 0, {}}, 0.1 - little, true},
                         {{0, 0, {}}, 0.1 + little, false},
                         {{0, 0.05, {}}, 0.05 - little, true},  // `world` is not for the two links
                         {{0, 0.15 - little, {}}, 0.05, true},
                         {{0, 0.15 + little, {}}, 0.05, false},
                         {{0.05 - little, 0, {}}, 0.05, true},  // `self` is
                         {{0.05 + little, 0, {}}, 0.05, false},
                         {{0, 0, {{{0, 2}, 0.2 + little}}}, 0, false},  // a single pair
                         {{0, 0.3, {{{0, 2}, 0.2 - little}, {{1, 2}, 0.1}}}, 0, true},
                         {{0.3, 0, {{{0, 1}, 0.05}}}, 0, true}}) {
    Problem problem;
    problem.source.name = "slides";
    KinematicTree& tree = problem.model.tree;
    tree.frames.resize(3);
    for (std::size_t f = 1; f < 3; ++f) {
      tree.frames[f].name = f == 1 ? "near" : "far";
      tree.frames[f].joint = Frame::Joint::prismatic;
      tree.frames[f].axis = Vec3::UnitX();
      tree.frames[f].variable = f - 1;
    }
    problem.model.space = lines(2, 5);
    problem.model.robots.resize(1);
    problem.model.bodies = {{"near", 1, 0, {partShape("near", Sphere{0.5})}},
                            {"far", 2, 0, {partShape("far", Sphere{0.5}, {1.1, 0, 0})}},
                            {"post", 0, {}, {partShape("post", Sphere{0.3}, {0.5, -1, 0})}}};
    problem.task.margin = margin;
    problem.task.padding.beyond = beyond;
    problem.task.tube = Configuration::Zero(2);
    const Configuration from = Configuration::Zero(2), to = Eigen::Vector2d(1, 2);
    EXPECT_EQ(Checker(problem).isProvedFree(from, to), free) << margin;
    EXPECT_EQ(verifyPath(plainProblem(problem), {from, to}).verdict,
              free ? PathVerdict::proved : PathVerdict::refuted)
        << margin;
  }
}

TEST(Padding, IsNotForBodiesOfOneRobot) {
  Padding padding;
  padding.bodies = {{0, 0.1}, {3, 0.2}};
  padding.pairs[{1, 3}] = 0.4;
  EXPECT_EQ(padding.of(0, 3, true), 0);
  EXPECT_NEAR(padding.of(3, 0, false), 0.3, 1e-14);
  EXPECT_GE(padding.of(3, 0, false), 0.1 + 0.2);
  EXPECT_NEAR(padding.of(0, 5, false), 0.1, 1e-14);
  EXPECT_EQ(padding.of(3, 1, true), 0.4);
  EXPECT_EQ(padding.of(5, 6, false), 0);
  EXPECT_EQ(padding.largest(), 0.4);
  EXPECT_EQ(Padding().largest(), 0);
  EXPECT_EQ((Padding{{{0, 0.0}}, {{{0, 1}, 0.0}}}.largest()), 0);
  padding.pairs.clear();
  EXPECT_GE(padding.largest(), padding.of(0, 3, false));
  // An arm's links are adjacent, or near each other: they may be padded.
  Problem arm = test::armProblem();
  for (std::size_t i = 0; i < arm.model.bodies.size(); ++i)
    if (arm.model.bodies[i].robot) arm.task.padding.bodies[i] = 0.05;
  EXPECT_TRUE(Checker(arm).isProvedFree(arm.task.start));
}

TEST(Padding, PathsKeepIt) {
  Problem problem = twoBalls();
  problem.task.padding.bodies[0] = 0.12;
  problem.settings.seed = 3;
  const SolveReport report = solveProblem(problem);
  ASSERT_EQ(report.outcome, SolveOutcome::solved) << report.why;
  EXPECT_EQ(verifySolution(problem, makeSolution(problem, report)).verdict, PathVerdict::proved);
  problem.task.padding.bodies[0] = 0.4;
  EXPECT_EQ(verifyPath(plainProblem(problem), report.path).verdict, PathVerdict::refuted);
  // A preferred clearance is added to the distances that the padding requires.
  problem.task.padding.bodies[0] = 0.12;
  problem.settings.prefer.clearance = 0.14;
  const SolveReport clear = solveProblem(problem);
  ASSERT_TRUE(clear.clearance);
  EXPECT_EQ(verifySolution(problem, makeSolution(problem, clear)).verdict, PathVerdict::proved);
  EXPECT_GE(clear.clearance->proved, 0.1);  // two digits of 90 % of more than 0.12
}

TEST(Padding, MessagesNameIt) {
  Problem problem = twoBalls();
  problem.task.padding.bodies[1] = 0.3;
  const Checker checker(problem);
  const auto why = whyNotFree(poseOf(Rigid::SE2, 0, 0), checker);
  ASSERT_TRUE(why);
  EXPECT_THAT(*why,
              HasSubstr(" are 0.1 m apart; more than the margin and padding of 0.3 m is needed"));
  const ExactStateValidityChecker exact(
      std::make_shared<ompl::base::SpaceInformation>(
          std::make_shared<ProblemStateSpace>(problem.model.space)),
      checker);
  EXPECT_NEAR(checker.marginOf(0, 1), 0.3, 1e-14);
  EXPECT_EQ(checker.marginOf(2, 0), 0);
  const PathReport refuted =
      verifyPath(plainProblem(problem), {problem.task.start, problem.task.goals[0]});
  ASSERT_FALSE(refuted.findings.empty());
  EXPECT_EQ(refuted.findings[0].reason, "closer than margin and padding");
}

/// The verifier refines the proved clearance until it reaches the wanted clearance.
TEST(WantedClearance, IsProvedWhereThePathHasIt) {
  const Problem problem = twoBalls();
  PathProblem plain = plainProblem(problem);
  const auto proven = [&](double wanted) {
    plain.wantedClearance = wanted;
    const PathReport report = verifyPath(plain, {problem.task.start, problem.task.goals[0]});
    EXPECT_EQ(report.verdict, PathVerdict::proved);
    EXPECT_LE(report.provedClearance, 0.1);
    return report.provedClearance;
  };
  const double usual = proven(0);
  EXPECT_GE(usual, 0.09);
  ASSERT_LT(usual, 0.0995);
  EXPECT_GE(proven(0.0995), 0.0995);
  EXPECT_GE(proven(0.0999), 0.0999);
  // If more is wanted than the path has, nearly its own clearance is proved.
  EXPECT_GE(proven(0.101), 0.0989);
  EXPECT_EQ(proven(5), proven(0.101));
}

TEST(Padding, RefusesWrongNumbers) {
  for (const double metres : {-0.1, std::nan(""), HUGE_VAL}) {
    Problem problem = twoBalls();
    problem.task.padding.pairs[{0, 1}] = metres;
    EXPECT_THROW(Checker{problem}, std::invalid_argument);
    const Problem sound = twoBalls();
    PathProblem plain = plainProblem(sound);
    plain.pairs[0].padding = metres;
    EXPECT_THROW(verifyPath(plain, {problem.task.start}), std::invalid_argument);
    plain.pairs[0].padding = 0;
    plain.wantedClearance = metres;
    EXPECT_THROW(verifyPath(plain, {problem.task.start}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace corridor
