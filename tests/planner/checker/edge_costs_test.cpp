// Tests that counts and shares of edge costs add up, and that the sampling of edges ends in time.
#include "planner/checker/edge_costs.h"

#include <gtest/gtest.h>

#include "tests/planner/checker/hall.h"

namespace corridor {
namespace {

TEST(EdgeCosts, CountsAndSharesAddUp) {
  const Problem problem = test::hallProblem(test::Rigid::SE3);
  const Checker checker(problem);
  const EdgeCosts costs = sampleEdgeCosts(checker, 20, 1e9, 1);
  EXPECT_EQ(costs.edges, 20u);
  EXPECT_LE(costs.free, costs.edges);
  EXPECT_EQ(costs.freeSeconds > 0, costs.free > 0);
  EXPECT_EQ(costs.otherSeconds > 0, costs.free < costs.edges);
  ASSERT_FALSE(costs.pairs.empty());
  double sum = 0;
  for (const EdgeCosts::OfPair& pair : costs.pairs) sum += pair.share;
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(EdgeCosts, OfPaddedBodies) {
  Problem problem = test::armProblem();
  problem.task.padding.bodies[0] = 0.01;
  const Checker checker(problem);
  ASSERT_GT(checker.scene().motionPairs().size(), 1u) << "each pair is measured alone";
  EXPECT_FALSE(sampleEdgeCosts(checker, 5, 1e9, 1).pairs.empty());
}

TEST(EdgeCosts, TestsOneEdgeAtLeastAndStopsInTime) {
  const Problem problem = test::hallProblem(test::Rigid::SE3);
  const Checker checker(problem);
  EXPECT_EQ(sampleEdgeCosts(checker, 1'000'000, 0, 1).edges, 1u);
}

}  // namespace
}  // namespace corridor
