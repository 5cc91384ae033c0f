#include "collision/course/cost_model.h"

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(CostModel, FindsTheCostsOfQueriesThatFollowIt) {
  for (const double call : {0.0, 500.0}) {
    std::vector<QueryCost> queries;
    for (int i = 1; i < 20; ++i) {
      const double v = 100.0 * i, p = 7.0 * i * i;
      queries.push_back({v, p, call + 12 * v + 90 * p});
    }
    const CostModel model = fittedCosts(queries, call);
    EXPECT_NEAR(model.box, 12, 1e-9);
    EXPECT_NEAR(model.triangle, 90, 1e-9);
    EXPECT_NEAR(model.predicted({10, 2, 1}), 300, 1e-8) << "without the call";
  }
}

/// If the cost per test differs between two queries, the fit must not follow the longest or the
/// shortest query alone.
TEST(CostModel, QueriesAreWeightedByTheirTime) {
  const CostModel model = fittedCosts({{1, 0, 10}, {1000, 0, 20'000}});
  EXPECT_NEAR(model.box, 1001 / (0.1 + 50), 1e-9);
}

TEST(CostModel, CostsAreNeverNegative) {
  const CostModel boxes = fittedCosts({{10, 1, 100}, {10, 2, 90}, {10, 4, 80}});
  EXPECT_GT(boxes.box, 8);
  EXPECT_EQ(boxes.triangle, 0);
  const CostModel triangles = fittedCosts({{1, 10, 100}, {2, 10, 90}, {4, 10, 80}});
  EXPECT_EQ(triangles.box, 0);
  EXPECT_GT(triangles.triangle, 8);
  const CostModel none = fittedCosts({{5, 0, 100}}, 200);
  EXPECT_EQ(none.box, 0);
}

/// A cost is known if the queries determine it. Here the times have an error of 5 %.
TEST(CostModel, CostsThatQueriesDoNotDetermineAreUnknown) {
  const auto fitted = [](double spread) {
    std::vector<QueryCost> queries;
    for (int i = 1; i < 40; ++i) {
      const double v = 100.0 * i, p = 50.0 * i * (1 + spread * (i % 3 - 1));
      queries.push_back({v, p, (12 * v + 90 * p) * (i % 2 ? 1.05 : 0.95)});
    }
    return fittedCosts(queries);
  };
  EXPECT_TRUE(fitted(0.5).boxKnown);
  EXPECT_TRUE(fitted(0.5).triangleKnown);
  EXPECT_FALSE(fitted(0.001).boxKnown);
  EXPECT_FALSE(fitted(0.001).triangleKnown);
  EXPECT_FALSE(fitted(0).boxKnown);
  // Only one of the costs occurs.
  EXPECT_TRUE(fittedCosts({{5, 0, 100}, {7, 0, 130}, {9, 0, 190}}).boxKnown);
  EXPECT_TRUE(fittedCosts({{0, 5, 100}, {0, 7, 130}}).triangleKnown);
}

/// If the two counts are proportional, only one cost can be determined; it is attributed to box
/// tests.
TEST(CostModel, ProportionalCountsGiveOneCost) {
  const CostModel model = fittedCosts({{10, 5, 100}, {20, 10, 200}, {40, 20, 400}});
  EXPECT_NEAR(model.box, 10, 1e-9);
  EXPECT_EQ(model.triangle, 0);
  EXPECT_NEAR(fittedCosts({{10, 5, 90}, {10, 5, 110}}).box, 10, 0.2);
  for (int k = 1; k < 100; ++k) {  // with sums that round differently
    const double t = 3, v = 7;
    EXPECT_EQ(fittedCosts({{v, v * k, t}, {2 * v + 1, (2 * v + 1) * k, 5 * t}}).triangle, 0) << k;
  }
  EXPECT_EQ(fittedCosts({{0, 0, 100}}).predicted({1, 1, 1}), 0);
}

}  // namespace
}  // namespace corridor
