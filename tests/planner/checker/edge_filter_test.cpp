// The filter of arms changes no verdict.
#include "planner/checker/edge_filter.h"

#include <random>

#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Random = std::mt19937_64;

std::string problemFile(const std::string& name) {
  return std::string(CORRIDOR_SOURCE_DIR) + "/problems/" + name + "/problem.yaml";
}

Configuration stateWithin(const Problem& problem, Random& random) {
  Configuration q(static_cast<Eigen::Index>(problem.model.space.size()));
  for (const Coordinate& c : problem.model.space.coordinates()) {
    const bool line = c.kind == Coordinate::Kind::line;
    q[static_cast<Eigen::Index>(c.first)] =
        std::uniform_real_distribution(line ? c.lower : -3.1, line ? c.upper : 3.1)(random);
  }
  return q;
}

/// An edge of a random length; of length 0, a state.
struct AskedEdge {
  Configuration from, to;
};
std::vector<AskedEdge> randomEdges(const Problem& problem, int count, Random& random) {
  std::vector<AskedEdge> edges;
  for (int n = 0; n < count; ++n) {
    const Configuration from = stateWithin(problem, random), to = stateWithin(problem, random);
    const double part = std::array{0.0, 0.02, 0.3, 1.0}[static_cast<std::size_t>(n % 4)];
    edges.push_back({from, from + part * (to - from)});
  }
  return edges;
}

bool hasFilter(const Problem& problem) {
  const Checker checker(problem);
  return EdgeFilter::make(problem.model, checker.scene(), checker.tube()) != nullptr;
}

class EdgeFilterOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Problems, EdgeFilterOf,
                         testing::Values("arm_at_shelf", "two_arms", "gantry_bins"));

TEST_P(EdgeFilterOf, ChangesNoVerdict) {
  const Problem problem = readProblem(problemFile(GetParam()));
  ASSERT_TRUE(hasFilter(problem));
  Problem plain = problem;  // the filter is only for the default trees
  plain.settings.checker.trees.volume = "obb";
  Random random(test::testSeed(81));
  const Checker checker(problem), other(problem), without(plain);
  const std::vector<AskedEdge> edges =
      randomEdges(problem, (test::isStressRun() ? 20'000 : 400) / test::kSlowdown, random);
  std::vector<double> metres(checker.scene().pairs().size());
  for (double& margin : metres) margin = std::uniform_real_distribution(0.0, 0.02)(random);
  const PairMargins margins(metres);
  int free = 0, kept = 0;
  std::vector<MotionResult> results;
  for (const AskedEdge& edge : edges) {
    const MotionResult result = checker.certifyEdge(edge.from, edge.to);
    results.push_back(result);
    EXPECT_EQ(result.verdict, without.certifyEdge(edge.from, edge.to).verdict);
    free += result.verdict == MotionVerdict::free;
    if (result.verdict == MotionVerdict::contact) {
      EXPECT_TRUE(result.pair);
      EXPECT_TRUE(
          checker.interference(problem.model.space.interpolate(edge.from, edge.to, result.time)));
    }
    const MotionVerdict own =
        checker.certifyEdge(edge.from, edge.to, {.margins = &margins}).verdict;
    EXPECT_EQ(own == MotionVerdict::free,
              without.certifyEdge(edge.from, edge.to, {.margins = &margins}).verdict ==
                  MotionVerdict::free);
    kept += own == MotionVerdict::free;
    EXPECT_EQ(checker.isProvedFree(edge.from), without.isProvedFree(edge.from));
  }
  EXPECT_GT(free, 0);
  EXPECT_LT(free, static_cast<int>(edges.size()));
  EXPECT_GT(kept, 0);
  // In another order, every answer is the same.
  for (std::size_t i = edges.size(); i-- > 0;) {
    const MotionResult result = other.certifyEdge(edges[i].from, edges[i].to);
    EXPECT_EQ(result.verdict, results[i].verdict) << "edge " << i;
    EXPECT_EQ(result.time, results[i].time) << "edge " << i;
  }
}

/// On long edges and states of arms, the filter proves most pairs.
TEST_P(EdgeFilterOf, ProvesMostPairs) {
  const Problem problem = readProblem(problemFile(GetParam()));
  const Checker checker(problem);
  const auto filter = EdgeFilter::make(problem.model, checker.scene(), checker.tube());
  EdgeFilter::Workspace workspace(filter.get());
  Random random(test::testSeed(82));
  std::size_t left = 0, all = 0;
  for (const AskedEdge& edge : randomEdges(problem, 100, random)) {
    ASSERT_TRUE(filter->prove(edge.from, edge.to, checker.options(), workspace, nullptr));
    left += workspace.left.size();
    all += checker.scene().pairs().size();
  }
  EXPECT_LT(left, all / 4);
}

TEST(EdgeFilter, IsOnlyForJointsOfOneNumber) {
  EXPECT_FALSE(hasFilter(test::hallProblem(test::Rigid::SE3)));
  EXPECT_FALSE(hasFilter(test::hallProblem(test::Rigid::SE2)));
  EXPECT_FALSE(hasFilter(readProblem(problemFile("rover_door"))));
}

TEST(EdgeFilter, ProvesNothingOfEdgesThatDefineNoCurve) {
  const Problem problem = readProblem(problemFile("arm_at_shelf"));
  const Checker checker(problem);
  const auto filter = EdgeFilter::make(problem.model, checker.scene(), checker.tube());
  EdgeFilter::Workspace workspace(filter.get());
  Configuration wrong = problem.task.start;
  wrong[1] = std::nan("");
  EXPECT_FALSE(filter->prove(problem.task.start, wrong, checker.options(), workspace, nullptr));
  EXPECT_EQ(checker.certifyEdge(problem.task.start, wrong).reason, UndecidedReason::ambiguous);
}

}  // namespace
}  // namespace corridor
