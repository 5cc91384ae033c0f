#include "planner/app/cost_model.h"

#include <gtest/gtest.h>

namespace corridor::app {
namespace {

TEST(CostModel, FindsTheCostsOfQueriesThatFollowIt) {
  std::vector<QueryCost> queries;
  for (int i = 1; i < 20; ++i) {
    const double v = 100.0 * i, p = 7.0 * i * i;
    queries.push_back({v, p, 12 * v + 90 * p});
  }
  const CostModel model = fittedCosts(queries);
  EXPECT_NEAR(model.box, 12, 1e-9);
  EXPECT_NEAR(model.triangle, 90, 1e-9);
  EXPECT_NEAR(model.predicted({10, 2, 1}), 300, 1e-7);
}

/// Short queries count as much as long ones.
TEST(CostModel, ErrorsAreRelative) {
  const CostModel model = fittedCosts({{1, 0, 10}, {1000, 0, 20'000}});
  EXPECT_GT(model.box, 11);
  EXPECT_LT(model.box, 13) << "0.1 + 0.05 over 0.01 + 0.0025";
}

TEST(CostModel, CostsAreNeverNegative) {
  const CostModel boxes = fittedCosts({{10, 1, 100}, {10, 2, 90}, {10, 4, 80}});
  EXPECT_GT(boxes.box, 8);
  EXPECT_EQ(boxes.triangle, 0);
  const CostModel triangles = fittedCosts({{1, 10, 100}, {2, 10, 90}, {4, 10, 80}});
  EXPECT_EQ(triangles.box, 0);
  EXPECT_GT(triangles.triangle, 8);
}

/// Counts that are proportional tell one cost only.
TEST(CostModel, WhatIsNotToldApartIsOneCost) {
  const CostModel model = fittedCosts({{10, 5, 100}, {20, 10, 200}, {40, 20, 400}});
  EXPECT_NEAR(model.predicted({10, 5, 1}), 100, 1e-9);
  EXPECT_EQ(fittedCosts({{0, 0, 100}}).predicted({0, 0, 1}), 0);
}

TEST(CostModel, Quantiles) {
  EXPECT_EQ(quantile({3, 1, 2}, 0), 1);
  EXPECT_EQ(quantile({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantile({3, 1, 2}, 1), 3);
  EXPECT_EQ(quantile({5}, 0.95), 5);
}

}  // namespace
}  // namespace corridor::app
