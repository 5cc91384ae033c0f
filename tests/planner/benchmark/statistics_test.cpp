// Tests of confidence intervals of medians and shares against enumeration, simulation and published
// values.
#include "planner/benchmark/statistics.h"

#include <cmath>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace corridor {
namespace {

std::vector<double> upTo(std::size_t n) {
  std::vector<double> values(n);
  std::iota(values.begin(), values.end(), 1.0);
  return values;
}

/// Returns the probability that fewer than k, or more than n − k, of n values are below the median,
/// by counting all 2^n cases.
double missed(unsigned n, unsigned k) {
  unsigned ways = 0;
  for (unsigned set = 0; set < 1u << n; ++set) {
    const auto below = static_cast<unsigned>(__builtin_popcount(set));
    ways += below < k || below > n - k;
  }
  return ways / std::pow(2.0, n);
}

TEST(Statistics, MedianIntervalIsTheNarrowestWithItsConfidence) {
  for (unsigned n = 1; n <= 20; ++n) {
    const Interval i = medianInterval(upTo(n));
    if (std::isinf(i.from)) {
      EXPECT_LT(n, 6u);
      EXPECT_GT(missed(n, 1), 0.05) << n;
      continue;
    }
    const auto k = static_cast<unsigned>(i.from);
    EXPECT_EQ(i.to, n + 1 - k);
    EXPECT_LE(missed(n, k), 0.05) << n;
    EXPECT_GT(missed(n, k + 1), 0.05) << n;
  }
  // Published for ten values (Conover, Practical Nonparametric Statistics): the 2nd and the 9th.
  EXPECT_EQ(medianInterval(upTo(10)).from, 2);
  EXPECT_EQ(medianInterval(upTo(10)).to, 9);
  EXPECT_EQ(medianInterval({5, 3, 1, 4, 2, 6}).from, 1);  // any order
  EXPECT_TRUE(std::isinf(medianInterval({}).to));
  // For many values the binomial distribution is nearly normal: 1.96·√n/2 = 980 ranks below the
  // middle, within a rank of the continuity correction and one of the approximation.
  EXPECT_NEAR(medianInterval(upTo(1'000'000)).from, 500'000 - 980, 2);
}

TEST(Statistics, MedianIntervalHasItsCoverage) {
  const unsigned seed = std::random_device{}();
  std::mt19937 random(seed);
  std::lognormal_distribution<double> draw(0, 2);  // the median is 1
  int covered = 0;
  constexpr int kTrials = 4000;
  for (int t = 0; t < kTrials; ++t) {
    std::vector<double> values(15);
    for (double& v : values) v = draw(random);
    const Interval i = medianInterval(values);
    covered += i.from <= 1 && 1 <= i.to;
  }
  // For 15 values the coverage is 1 − 2·P(B ≤ 3) = 0.9648; six standard errors of 4,000 trials are
  // 0.018.
  EXPECT_NEAR(covered / double{kTrials}, 0.9648, 0.018) << "seed " << seed;
}

TEST(Statistics, ShareIntervalIsWilsons) {
  // Newcombe 1998, table I: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
  const auto near = [](std::size_t hits, std::size_t of, double from, double to) {
    const Interval i = shareInterval(hits, of);
    EXPECT_NEAR(i.from, from, 5e-5);
    EXPECT_NEAR(i.to, to, 5e-5);
  };
  near(81, 263, 0.2553, 0.3662);
  near(15, 148, 0.0624, 0.1605);
  near(0, 20, 0, 0.1611);
  near(1, 29, 0.0061, 0.1718);
  EXPECT_EQ(shareInterval(0, 20).from, 0);
  EXPECT_EQ(shareInterval(20, 20).to, 1);
  EXPECT_EQ(shareInterval(0, 0).to, 1);
}

}  // namespace
}  // namespace corridor
