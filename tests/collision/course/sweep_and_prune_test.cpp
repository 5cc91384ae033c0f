#include "collision/course/sweep_and_prune.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

BoundingBox boundingBox(const Vec3& lower, const Vec3& upper) {
  BoundingBox result;
  result.lower = lower;
  result.upper = upper;
  return result;
}

using Pairs = std::set<std::pair<std::size_t, std::size_t>>;

Pairs bruteForce(const std::vector<BoundingBox>& boxes) {
  Pairs pairs;
  for (std::size_t a = 0; a < boxes.size(); ++a)
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      bool overlap = true;
      for (int k = 0; k < 3; ++k)
        overlap = overlap && boxes[a].lower[k] <= boxes[b].upper[k] &&
                  boxes[b].lower[k] <= boxes[a].upper[k];
      if (overlap) pairs.insert({a, b});
    }
  return pairs;
}

Pairs pairsOf(const SweepAndPrune& sweep) {
  Pairs pairs;
  sweep.forEachPair([&](std::uint32_t a, std::uint32_t b) { pairs.insert({a, b}); });
  EXPECT_EQ(pairs.size(), sweep.pairCount());
  return pairs;
}

/// Boxes move a little, jump, shrink to points, or touch (on a grid). After each step, the pairs
/// must be those of brute force.
TEST(SweepAndPrune, AgreesWithBruteForce) {
  std::mt19937_64 random(test::testSeed(61));
  const int runs = test::isStressRun() ? 2000 : 100 / test::kSlowdown + 2;
  std::size_t pairs = 0;
  for (int n = 0; n < runs; ++n) {
    const bool grid = n % 2;
    const auto real = [&] {
      return grid ? static_cast<double>(random() % 9)
                  : std::uniform_real_distribution(0.0, 9.0)(random);
    };
    const auto randomBox = [&] {
      const Vec3 lower(real(), real(), real());
      const double size = grid ? static_cast<double>(random() % 4) : 0.4 * real();
      return boundingBox(lower, lower + Vec3(size, random() % 3 ? size : 0.0, size));
    };
    std::vector<BoundingBox> boxes(random() % 40);
    for (BoundingBox& each : boxes) each = randomBox();
    SweepAndPrune sweep(boxes);
    ASSERT_EQ(pairsOf(sweep), bruteForce(boxes)) << n;
    for (int step = 0; step < 40 && !boxes.empty(); ++step) {
      const std::size_t item = random() % boxes.size();
      if (random() % 4 == 0) {
        boxes[item] = randomBox();
      } else {
        const Vec3 by = grid ? Vec3(static_cast<double>(random() % 3) - 1, 0, 1)
                             : Vec3(0.1 * real() - 0.4, 0.1 * real() - 0.4, 0);
        boxes[item].lower += by;
        boxes[item].upper += by;
      }
      sweep.move(item, boxes[item]);
      const Pairs expected = bruteForce(boxes);
      ASSERT_EQ(pairsOf(sweep), expected) << n << " " << step;
      pairs += expected.size();
    }
    if (boxes.size() > 1) {
      EXPECT_EQ(sweep.overlaps(1, 0), bruteForce(boxes).contains({0, 1}));
    }
  }
  std::cout << pairs << " pairs\n";
}

/// The cost of a step must depend only on the boxes that move: among 10^4 boxes in a row, a box
/// that moves by its own size passes few ends of other boxes.
TEST(SweepAndPrune, OnlyWhatMovedIsVisited) {
  std::vector<BoundingBox> boxes;
  for (int i = 0; i < 10'000; ++i) {
    const Vec3 lower(2.0 * i, 2.0 * (i * 7919 % 10'000), 2.0 * (i * 104'729 % 10'000));
    boxes.push_back(boundingBox(lower, lower + Vec3(1.5, 1.5, 1.5)));
  }
  SweepAndPrune sweep(boxes);
  const std::uint64_t before = sweep.swaps();
  boxes[5000].lower += Vec3(1.5, 1.5, 1.5);
  boxes[5000].upper += Vec3(1.5, 1.5, 1.5);
  sweep.move(5000, boxes[5000]);
  EXPECT_LE(sweep.swaps() - before, 20u);
  EXPECT_EQ(pairsOf(sweep), bruteForce(boxes));
}

TEST(SweepAndPrune, InvalidBoxesAndItemsAreRefused) {
  const std::vector<BoundingBox> one = {boundingBox({0, 0, 0}, {1, 1, 1})};
  const std::vector<BoundingBox> wrong = {boundingBox({0, 2, 0}, {1, 1, 1})},
                                 none = {boundingBox({0, 0, 0}, {1, std::nan(""), 1})};
  EXPECT_THROW(SweepAndPrune{wrong}, std::invalid_argument);
  EXPECT_THROW(SweepAndPrune{none}, std::invalid_argument);
  SweepAndPrune sweep(one);
  EXPECT_THROW(sweep.move(1, one[0]), std::invalid_argument);
  EXPECT_THROW(sweep.move(0, none[0]), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
