// Tests how a distance query chooses among the pairs of leaves that remain at its end. The test
// makes up ranges and measured distances of pairs. The errors of both are as large as they can be
// for triangles and convex parts.
#include "collision/queries/nearest_pairs.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

struct Numbers {
  static std::uint32_t meshTriangle(std::uint32_t i) { return i; }
};
struct Measured {
  double distance = 0;
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
};

/// Pairs of items with equal indices (i, i), whose distances are known.
class MadeUp : public NearestPairs {
 public:
  using NearestPairs::NearestPairs;
  void look(std::uint32_t i, double lower, double upper) { keep(i, i, lower, upper); }
  Distance nearestOf(const std::vector<double>& measures) {
    return closest(Numbers(), Numbers(),
                   [&](std::uint32_t i, std::uint32_t) { return Measured{measures[i]}; });
  }
};

/// The distances are nearly equal, or exceed the least distance by as much as the options allow.
/// Their order is random. The result must exceed the least distance by no more than distance.h
/// allows.
TEST(NearestPairs, TiesStayWithinTheAllowedError) {
  std::mt19937_64 random(test::testSeed(53));
  const auto real = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  QueryContext context;
  double worst = -HUGE_VAL;
  int above = 0;
  for (int n = 0; n < 200'000; ++n) {
    DistanceOptions options;
    if (n % 4 == 1) options.relative = std::pow(10.0, real(-3, 1));
    if (n % 4 == 2) options.absolute = std::pow(10.0, real(-3, 3));
    const double least = real(1, 2), allowed = least * options.relative + options.absolute + least;
    MadeUp pairs(options, context);
    std::vector<double> measures;
    std::uint32_t first = 0;
    for (std::uint32_t i = 0; i < 5; ++i) {
      const double base = i == 0 ? least : n % 2 && i == 1 ? least : allowed;
      const double d = i == 0 ? least : base * (1 + real(0, 1.3e-12));
      // A measured distance is too large by at most a factor of 1 + 2^-41. A range is as wide as
      // rounding makes it for bodies far from the origin.
      measures.push_back(d * (1 + real(0, 0x1p-41)));
      const double loose = i % 2 ? 0 : real(0, 2e-12);
      if (i == 0) continue;
      pairs.look(i, d * (1 - loose), d);
      if (++first == 2) pairs.look(0, least, least);
    }
    const double excess = (pairs.nearestOf(measures).distance - allowed);
    worst = std::max(worst, excess / (allowed + std::max(excess, 0.0)));
    above += excess > 0.3e-12 * allowed;
    ASSERT_LE(excess, 1e-12 * (allowed + excess)) << n;
  }
  EXPECT_GT(above, 100) << worst;  // some pairs are left unmeasured
  RecordProperty("worst", std::to_string(worst));
}

/// A pair that may touch is measured even if the options allow the query to skip it. A NaN must not
/// exclude any pair.
TEST(NearestPairs, PairsThatMayTouchAreMeasured) {
  QueryContext context;
  const DistanceOptions options{.relative = 1, .absolute = 1};
  MadeUp pairs(options, context);
  pairs.look(0, 0.5, 0.5);
  pairs.look(1, 0, 0.4);
  EXPECT_EQ(pairs.nearestOf({0.5, 0.25}).distance, 0.25);
  EXPECT_TRUE(pairs.canImprove(std::nan("")));
}

}  // namespace
}  // namespace corridor
