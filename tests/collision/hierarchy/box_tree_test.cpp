// Compares queries of the tree over the boxes of bodies with tests of all boxes.
#include "collision/hierarchy/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor::test {
namespace {

double gap(const BoundingBox& box, const Vec3& p) {
  return (p - box.upper).cwiseMax(box.lower - p).cwiseMax(Vec3::Zero()).norm();
}

/// Returns a vector of three numbers in [-1, 1].
Vec3 anyVec(std::mt19937_64& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  const double x = real(random), y = real(random), z = real(random);
  return {x, y, z};
}

TEST(BoxTree, FindsWhatATestOfAllBoxesFinds) {
  std::mt19937_64 random(testSeed(241));
  std::uniform_real_distribution<double> real(-1, 1);
  const auto any = [&] { return anyVec(random); };
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

BoundingBox cube(const Vec3& c, double half) {
  const Vec3 h = Vec3::Constant(half);
  return {c - h, c + h, (c - h).cwiseAbs().sum() + (c + h).cwiseAbs().sum()};
}

/// A crowd of boxes far away must cost little: queries skip the whole crowd at a node near the
/// root. If the tree were split at the median, the few near boxes would be ten levels deep.
TEST(BoxTree, PassesOverAFarCrowdNearTheRoot) {
  std::vector<BoundingBox> near, all;
  for (int i = 0; i < 8; ++i) near.push_back(cube(Vec3(i % 2, i / 2 % 2, i / 4), 0.1));
  all = near;
  for (int i = 0; i < 10000; ++i)
    all.push_back(cube(Vec3(10 + 0.2 * (i % 100), 5 + 0.2 * (i / 100), 0.5), 0.05));
  const auto testsIn = [](const std::vector<BoundingBox>& boxes) {
    std::size_t tests = 0, found = 0;
    BoxTree(boxes).walk(
        [&](const BoundingBox& box) {
          ++tests;
          return gap(box, Vec3(1, 1, 1));
        },
        0.2, [&](std::size_t) { return ++found == boxes.size(); });
    EXPECT_EQ(found, 1U);
    return tests;
  };
  EXPECT_LE(testsIn(all), testsIn(near) + 8);
}

/// Boxes for which the split heuristic cannot choose, or would make a tree that is too deep.
TEST(BoxTree, FindsAllOfOddBoxes) {
  std::vector<std::vector<BoundingBox>> sets(4);
  for (int i = 0; i < 1000; ++i) {
    sets[0].push_back(cube(Vec3(1, 2, 3), 0));  // one point
    sets[1].push_back(cube(Vec3(i, 0, 0), 0));  // points of a line
    // A sequence that converges to 0.
    sets[2].push_back(cube(Vec3::Constant(std::ldexp(1.0, -i)), 1e-9));
    sets[3].push_back(cube(Vec3(1e200 * (i - 500), 1e308 * (i % 3 - 1), i), 1e100));  // overflow
  }
  std::vector<BoundingBox> infinite = sets[1];
  const double infinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < infinite.size(); i += 3)
    infinite[i] = {Vec3::Constant(-infinity), Vec3::Constant(infinity), infinity};
  sets.push_back(infinite);
  for (const std::vector<BoundingBox>& boxes : sets) {
    const BoxTree tree(boxes);
    std::set<std::size_t> found;
    tree.walk([](const BoundingBox&) { return 0.0; }, 0,
              [&](std::size_t i) {
                found.insert(i);
                return false;
              });
    EXPECT_EQ(found.size(), boxes.size());
    // The boxes of inner nodes must contain each leaf.
    for (std::size_t i = 0; i < boxes.size(); i += 37) {
      bool seen = false;
      const Vec3 p = boxes[i].lower;
      tree.walk(
          [&](const BoundingBox& box) {
            return (box.lower.array() <= p.array()).all() && (p.array() <= box.upper.array()).all()
                       ? 0.0
                       : 1.0;
          },
          0,
          [&](std::size_t k) {
            seen = seen || k == i;
            return false;
          });
      EXPECT_TRUE(seen) << i;
    }
  }
}

/// After each of many random changes, the tree must find what a test of all boxes finds.
TEST(BoxTree, ChangesLikeAListOfBoxes) {
  std::mt19937_64 random(testSeed(242));
  std::uniform_real_distribution<double> real(-1, 1);
  const auto any = [&] { return anyVec(random); };
  const auto anyBox = [&] { return cube(5 * any(), 0.2 * std::abs(real(random))); };
  for (int round = 0; round < 20; ++round) {
    std::map<std::size_t, BoundingBox> boxes;
    BoxTree tree;
    if (round % 2) {  // starts with a built tree
      std::vector<BoundingBox> start;
      for (std::size_t i = 0; i < 100; ++i) boxes[i] = start.emplace_back(anyBox());
      tree = BoxTree(start);
    }
    for (int change = 0; change < 400; ++change) {
      const std::size_t item = random() % 150;
      if (!boxes.contains(item)) {
        EXPECT_THROW(tree.remove(item), std::invalid_argument);
        EXPECT_THROW(tree.refit(item, anyBox()), std::invalid_argument);
        tree.insert(item, boxes[item] = anyBox());
      } else if (change % 3 == 0) {
        tree.remove(item);
        boxes.erase(item);
      } else {
        EXPECT_THROW(tree.insert(item, anyBox()), std::invalid_argument);
        tree.refit(item, boxes[item] = anyBox());
      }
      if (change % 100 == 99) tree.rebuild();
      ASSERT_TRUE(tree.check()) << round << ", " << change;
      ASSERT_EQ(tree.size(), boxes.size());
      const Vec3 p = 5 * any();
      const double within = std::abs(real(random));
      std::set<std::size_t> expected, found;
      for (const auto& [number, box] : boxes)
        if (gap(box, p) <= within) expected.insert(number);
      tree.walk([&](const BoundingBox& box) { return gap(box, p); }, within,
                [&](std::size_t i) {
                  EXPECT_TRUE(found.insert(i).second);
                  return false;
                });
      ASSERT_EQ(found, expected);
    }
    while (!boxes.empty()) {  // down to an empty tree, and up again
      tree.remove(boxes.begin()->first);
      boxes.erase(boxes.begin());
      ASSERT_TRUE(tree.check());
    }
    EXPECT_EQ(tree.size(), 0U);
    tree.insert(7, anyBox());
    EXPECT_TRUE(tree.check());
    EXPECT_TRUE(tree.contains(7));
    EXPECT_FALSE(tree.contains(6));
  }
}

/// Insertions in sorted order, or of equal or infinite boxes. Without balancing, they would turn
/// the tree into a list. The cost of an insertion is bounded by the depth of the tree.
TEST(BoxTree, InsertionsInOrderMakeNoDeepTree) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const BoundingBox everywhere{Vec3::Constant(-infinity), Vec3::Constant(infinity), infinity};
  const auto row = [](std::size_t i) { return cube(Vec3(static_cast<double>(i), 0, 0), 0.3); };
  const auto halves = [](std::size_t i) {
    return cube(Vec3::Constant(std::ldexp(1.0, static_cast<int>(i % 1000) - 500)), 0);
  };
  const auto same = [](std::size_t) { return cube(Vec3(1, 2, 3), 0.3); };
  const auto afterInfinite = [&](std::size_t i) { return i == 0 ? everywhere : row(i); };
  constexpr std::size_t count = 3000;
  const auto depthOf = [&](const auto& boxOf) {
    BoxTree tree;
    for (std::size_t i = 0; i < count; ++i) {
      tree.insert(i, boxOf(i));
      if (i % 100 == 0) {
        EXPECT_TRUE(tree.check()) << i;
      }
    }
    EXPECT_TRUE(tree.check());
    return tree.height();
  };
  // Balancing begins beyond 2·12 + 4 levels, and may leave a few more.
  EXPECT_LE(depthOf(row), 32U);
  EXPECT_LE(depthOf(halves), 32U);
  EXPECT_LE(depthOf(same), 32U);
  EXPECT_LE(depthOf(afterInfinite), 32U);
}

TEST(BoxTree, RefusesWhatItCantFind) {
  BoxTree tree;
  BoundingBox wrong = cube(Vec3::Zero(), 1);
  wrong.upper[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(tree.insert(0, wrong), std::invalid_argument);
  EXPECT_THROW(tree.insert(std::size_t{1} << 31, cube(Vec3::Zero(), 1)), std::invalid_argument);
  EXPECT_EQ(tree.size(), 0U);
  tree.insert(0, cube(Vec3::Zero(), 1));
  EXPECT_THROW(tree.refit(0, wrong), std::invalid_argument);
  EXPECT_TRUE(tree.check());
}

/// If a few boxes have moved, a query needs far fewer tests than there are boxes, although the tree
/// is not rebuilt.
TEST(BoxTree, FindsLittleAfterMovesOfAFew) {
  std::vector<BoundingBox> boxes;
  for (int i = 0; i < 4096; ++i) boxes.push_back(cube(Vec3(i % 16, i / 16 % 16, i / 256), 0.3));
  BoxTree tree(boxes);
  for (std::size_t i = 0; i < 100; ++i) {
    const double shift = 0.01 * static_cast<double>(i);
    tree.refit(i * 37, cube(Vec3(15 - shift, shift, 8), 0.3));
  }
  ASSERT_TRUE(tree.check());
  std::size_t tests = 0;
  tree.walk(
      [&](const BoundingBox& box) {
        ++tests;
        return gap(box, Vec3(3, 9, 12));
      },
      0.5, [](std::size_t) { return false; });
  EXPECT_LT(tests, 1000U);
}

}  // namespace
}  // namespace corridor::test
