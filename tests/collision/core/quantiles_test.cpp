#include "collision/core/quantiles.h"

#include <cmath>

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(Quantiles, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(medianOf({3}), 3);
  EXPECT_EQ(medianOf({3, 1, 2}), 2);
  EXPECT_EQ(medianOf({9, 1, 5}), 5);
  EXPECT_EQ(medianOf({9, 1, 5, 3}), 4);
  EXPECT_EQ(medianOf({4, 1, 2, 3}), 2.5);
  EXPECT_TRUE(std::isnan(medianOf({})));
}

TEST(Quantiles, NearestRank) {
  std::vector<double> values;
  for (int i = 100; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(quantileOf(values, 0.95), 95);
  EXPECT_EQ(quantileOf({1, 2, 3, 4, 5, 6, 7, 8, 9, 10}, 0.95), 10);
  EXPECT_EQ(quantileOf({7}, 0.95), 7);
  EXPECT_EQ(quantileOf({5}, 0.95), 5);
  EXPECT_EQ(quantileOf({3, 1, 2}, 0), 1);
  EXPECT_EQ(quantileOf({3, 1, 2}, 0.5), 2);
  EXPECT_EQ(quantileOf({3, 1, 2}, 1), 3);
  EXPECT_TRUE(std::isnan(quantileOf({}, 0.95)));
}

/// If 95 % of the count is an integer, the rank is this integer, and rounding errors must not
/// increase the rank.
TEST(Quantiles, WholeRanksStayWhole) {
  for (std::size_t n = 20; n <= 20'000; n += 20) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = static_cast<double>(i + 1);
    EXPECT_EQ(quantileOf(values, 0.95), static_cast<double>(n / 20 * 19));
    EXPECT_EQ(quantileOf(values, 0.05), static_cast<double>(n / 20));
  }
}

}  // namespace
}  // namespace corridor
