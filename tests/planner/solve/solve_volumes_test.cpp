// With trees of any bounding volume, solving must give the same paths, at another cost.
#include <gtest/gtest.h>

#include "planner/solve/solution.h"
#include "planner/solve/verify_solution.h"
#include "tests/planner/checker/hall.h"

namespace corridor {
namespace {

using test::hallProblem;
using test::Rigid;

class SolveOnVolumes : public testing::TestWithParam<Rigid> {};
INSTANTIATE_TEST_SUITE_P(Both, SolveOnVolumes, testing::Values(Rigid::SE2, Rigid::SE3));

TEST_P(SolveOnVolumes, PathsAreFoundAndProved) {
  Problem problem = hallProblem(GetParam());
  const SolveReport usual = solveProblem(problem);
  const auto solved = [&](const std::string& edges, const TreeNames& words,
                          const std::string& checkerText) {
    problem.settings.checker.edges = edgeMethodNamed(edges).value();
    problem.settings.checker.resolution = 0.001;
    problem.settings.checker.trees.volume = words.volume;
    problem.settings.checker.trees.fit = words.fit;
    problem.settings.checker.trees.overlap = words.overlap;
    problem.settings.checker.trees.build = words.build;
    const SolveReport report = solveProblem(problem);
    ASSERT_EQ(report.outcome, SolveOutcome::solved) << checkerText << ": " << report.why;
    EXPECT_EQ(report.checker, checkerText);
    EXPECT_NE(report.counters.boxTests, usual.counters.boxTests) << checkerText;
    const Solution solution = makeSolution(problem, report);
    EXPECT_EQ(solution.checker, checkerText);
    if (edges == "discrete") return;  // such a path may step over the wall
    EXPECT_TRUE(report.certified) << checkerText;
    EXPECT_EQ(verifySolution(problem, solution).verdict, PathVerdict::proved) << checkerText;
    if (edges != "certified") return;
    EXPECT_EQ(report.path, usual.path)
        << checkerText << ": the path differs, though verdicts must not depend on the trees";
  };
  solved("certified", {"sphere", "", ""}, "certified, sphere");
  solved("certified", {"kdop26", "", ""}, "certified, kdop26");
  solved("certified", {"obb-binary", "", ""}, "certified, obb-binary");
  solved("certified", {"obb-binary", "hull", "gjk"}, "certified, obb-binary, hull, gjk");
  solved("certified", {"aabb", "", "", "bottom-up"}, "certified, aabb, bottom-up");
  solved("adaptive", {"rss", "", ""}, "adaptive, rss");
  solved("discrete", {"aabb", "", ""}, "discrete, resolution 0.001, aabb");
}

}  // namespace
}  // namespace corridor
