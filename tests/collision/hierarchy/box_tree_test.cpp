// Tests of the tree of bodies' boxes against tests of all boxes.
#include "collision/hierarchy/box_tree.h"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor::test {
namespace {

double gap(const BoundingBox& box, const Vec3& p) {
  return (p - box.upper).cwiseMax(box.lower - p).cwiseMax(Vec3::Zero()).norm();
}

TEST(BoxTree, FindsWhatATestOfAllBoxesFinds) {
  std::mt19937_64 random(testSeed(241));
  std::uniform_real_distribution<double> real(-1, 1);
  const auto any = [&] {
    const double x = real(random), y = real(random), z = real(random);
    return Vec3(x, y, z);
  };
  for (const std::size_t count : {0, 1, 2, 3, 7, 64, 1000}) {
    std::vector<BoundingBox> boxes;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 c = i % 5 == 0 ? Vec3::Zero() : any();  // many centres are equal
      const Vec3 h = 0.1 * any().cwiseAbs();
      boxes.push_back({c - h, c + h, (c - h).cwiseAbs().sum() + (c + h).cwiseAbs().sum()});
    }
    const BoxTree tree(boxes);
    for (int n = 0; n < 50; ++n) {
      const Vec3 p = 1.5 * any();
      const double within = n % 5 == 0 ? 0 : std::abs(real(random));
      std::set<std::size_t> expected, found;
      for (std::size_t i = 0; i < count; ++i)
        if (gap(boxes[i], p) <= within) expected.insert(i);
      std::size_t tests = 0;
      const auto bound = [&](const BoundingBox& box) {
        ++tests;
        return gap(box, p);
      };
      EXPECT_FALSE(tree.walk(bound, within, [&](std::size_t i) {
        EXPECT_TRUE(found.insert(i).second) << "each once";
        return false;
      }));
      EXPECT_EQ(found, expected);
      EXPECT_LE(tests, 2 * count);
      if (count == 1000 && found.empty()) {
        EXPECT_LT(tests, 500u);
      }

      // Finds the nearest box by lowering `within` to each smaller distance found.
      double least = 1e9;
      tree.walk([&](const BoundingBox& box) { return gap(box, p); }, least,
                [&](std::size_t i) {
                  least = std::min(least, gap(boxes[i], p));
                  return false;
                });
      double nearest = 1e9;
      for (const BoundingBox& box : boxes) nearest = std::min(nearest, gap(box, p));
      EXPECT_EQ(least, nearest);

      int visits = 0;
      EXPECT_EQ(tree.walk([](const BoundingBox&) { return 0.0; }, 0,
                          [&](std::size_t) { return ++visits == 2; }),
                count >= 2)
          << "the second visit stops the walk";
      EXPECT_EQ(visits, static_cast<int>(std::min<std::size_t>(count, 2)));
    }
  }
}

}  // namespace
}  // namespace corridor::test
