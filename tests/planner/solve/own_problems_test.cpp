// Tests that the problems in problems/ are solved, certified and verified with their own settings.
#include <algorithm>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/solve/solve.h"
#include "planner/solve/verify_solution.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

Problem ownProblem(const std::string& name) {
  return readProblem(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems" / name);
}

class OwnProblems : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, OwnProblems,
                         testing::Values("arm_at_shelf", "bug_trap", "cubicles", "gantry_bins",
                                         "hook_maze", "piano", "polygon_maze", "rod_hole",
                                         "rover_door", "snake_posts", "thin_plate", "twisted_tubes",
                                         "two_arms"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST_P(OwnProblems, SolvedByItsDefaultsCertifiedAndVerified) {
  Problem problem = ownProblem(GetParam());
  EXPECT_LE(problem.settings.planner.time, 60);
  problem.settings.planner.time *= test::kSlowdown;
  const SolveReport report = solveProblem(problem);
  ASSERT_EQ(report.outcome, SolveOutcome::solved) << report.why;
  EXPECT_TRUE(report.certified);
  const VerifyReport verified = verifySolution(problem, makeSolution(problem, report));
  EXPECT_EQ(verified.verdict, PathVerdict::proved);
}

TEST(OwnProblems, AllAreListedHere) {
  int folders = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems"))
    folders += std::filesystem::exists(entry.path() / "problem.yaml");
  EXPECT_EQ(folders, 13);
}

/// Prismatic joints and a moving base don't change the default range of an arm. Other robots have
/// OMPL's default range.
TEST(OwnProblems, DefaultRanges) {
  for (const auto& [name, isArm] :
       {std::pair("gantry_bins", true), {"rover_door", true}, {"cubicles", false}}) {
    Problem problem = ownProblem(name);
    problem.settings.simplify = Simplifier::none;
    problem.settings.planner.time *= test::kSlowdown;
    const auto path = [&](const std::map<std::string, std::string>& params) {
      problem.settings.planner.params = params;
      return solveProblem(problem).path;
    };
    const Path own = path({});
    ASSERT_FALSE(own.empty()) << name;
    EXPECT_EQ(own == path({{"range", "0.7"}}), isArm) << name;
    EXPECT_EQ(own == path({{"range", "0"}}), !isArm) << name;
  }
}

/// Some states must be in contact only because the two arms touch each other.
TEST(TwoArms, AreTestedAgainstEachOther) {
  Problem problem = ownProblem("two_arms");
  const auto between = [&](std::size_t i, std::size_t j) {
    const auto &a = problem.model.bodies[i].robot, &b = problem.model.bodies[j].robot;
    return a && b && *a != *b;
  };
  Problem apart = problem;
  std::size_t tested = 0;
  forEachTestedPair(problem.model, requiredBy(problem.task), [&](std::size_t a, std::size_t b) {
    if (!between(a, b)) return;
    ++tested;
    apart.model.filter.skip(a, b, "left out by this test");
  });
  EXPECT_GT(tested, 0u);
  // In many states the only contacts are those between the arms.
  const Checker together(problem), alone(apart);
  std::mt19937_64 random(1);
  int differ = 0;
  for (int i = 0; i < 300; ++i) {
    Configuration q(static_cast<Eigen::Index>(problem.model.space.size()));
    for (const Coordinate& c : problem.model.space.coordinates())
      q[static_cast<Eigen::Index>(c.first)] =
          std::uniform_real_distribution(std::max(c.lower, -1.5), std::min(c.upper, 1.5))(random);
    const bool free = alone.isProvedFree(q), freeTogether = together.isProvedFree(q);
    EXPECT_TRUE(free || !freeTogether);
    differ += free && !freeTogether;
  }
  EXPECT_GT(differ, 0);
}

/// The body is 1 mm thick, and the plate is 0.1 mm thick, so samples in steps of 1 % jump over the
/// plate. Sampled edges give paths straight through the plate; certified edges never do.
TEST(ThinPlate, DiscreteGoesThroughAndCertifiedNeverDoes) {
  Problem problem = ownProblem("thin_plate");
  const auto verdict = [&](std::uint64_t seed) {
    problem.settings.seed = seed;
    const SolveReport report = solveProblem(problem);
    EXPECT_EQ(report.outcome, SolveOutcome::solved) << "seed " << seed << ": " << report.why;
    return report.path.empty() ? PathVerdict::undecided
                               : verifySolution(problem, makeSolution(problem, report)).verdict;
  };
  for (std::uint64_t seed = 1; seed <= 100 / test::kSlowdown; ++seed)
    ASSERT_EQ(verdict(seed), PathVerdict::proved) << "certified, seed " << seed;
  problem.settings.checker.edges = EdgeMethod::discrete;
  int refuted = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) refuted += verdict(seed) == PathVerdict::refuted;
  EXPECT_GT(refuted, 5) << "paths of the discrete checker that collide, of 10";
}

}  // namespace
}  // namespace corridor
