#include "collision/hierarchy/tree_builder.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/meshes.h"

namespace corridor {
namespace {

/// Returns a triangle with this centroid, in the plane z = centroid.z. Its extent is 12 along x,
/// and 6 along y. If the centroid's coordinates are small integers, no sum of coordinates is
/// rounded.
Triangle triangleAround(const Vec3& centroid) {
  return {centroid + Vec3(-8, 2, 0), centroid + Vec3(4, 2, 0), centroid + Vec3(4, -4, 0)};
}

/// Builds a tree whose boxes have the coordinate axes, over triangles around these centroids.
/// Returns which of them the left child of the root has, as a sum of 2^i; 0 if the root is a leaf.
/// `order` says which axis takes the place of x, of y and of z.
unsigned leftOf(const std::vector<Vec3>& centroids, SplitRule rule,
                const std::array<int, 3>& order) {
  const auto reordered = [&](const Vec3& v) {
    Vec3 result;
    for (int i = 0; i < 3; ++i) result[order[static_cast<std::size_t>(i)]] = v[i];
    return result;
  };
  TriangleMesh mesh;
  for (const Vec3& centroid : centroids) {
    const Triangle t = triangleAround(centroid);
    test::add(mesh, reordered(t[0]), reordered(t[1]), reordered(t[2]));
  }
  TreePrimitives items(mesh);
  const Skeleton nodes = buildSkeleton(items, false, {ObbFit::triangles, rule});
  const Vec3& half = nodes[0].box.half;
  EXPECT_GT(half[order[0]], half[order[1]]);
  EXPECT_GT(half[order[1]], half[order[2]]);
  unsigned left = 0;
  if (nodes[0].right != 0)
    for (std::uint32_t i = 0; i < nodes[1].count; ++i)
      left |= 1U << items.numbers[nodes[1].first + i];
  return left;
}

constexpr std::array<std::array<int, 3>, 6> kOrders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

class SplitRules : public testing::TestWithParam<SplitRule> {};

/// The centroids differ along all three axes, in three ways: x divides {0, 1} from {2, 3}, y {0, 2}
/// from {1, 3}, and z {0, 3} from {1, 2}.
TEST_P(SplitRules, TheLongestAxisIsFirst) {
  for (const auto& order : kOrders)
    EXPECT_EQ(leftOf({{-2, -1, -1}, {-2, 1, 1}, {2, -1, 1}, {2, 1, -1}}, GetParam(), order),
              0b0011U);
}

/// All centroids have the same x, along which the box is longest: no plane across x divides them.
TEST_P(SplitRules, TheSecondLongestAxisIsNext) {
  for (const auto& order : kOrders)
    EXPECT_EQ(leftOf({{0, -1, -1}, {0, 1, 1}, {0, -1, 1}, {0, 1, -1}}, GetParam(), order), 0b0101U);
}

/// All centroids have the same x and y.
TEST_P(SplitRules, TheShortestAxisIsLast) {
  for (const auto& order : kOrders)
    EXPECT_EQ(leftOf({{0, 0, -1}, {0, 0, 1}, {0, 0, 1}, {0, 0, -1}}, GetParam(), order), 0b1001U);
}

/// If no axis divides the centroids, the root is a leaf with all of the triangles.
TEST_P(SplitRules, EqualCentroidsAreALeaf) {
  TriangleMesh mesh;
  for (const double size : {1.0, 2.0, 4.0})
    test::add(mesh, {size * Vec3(-2, 1, 0), size * Vec3(1, 1, 0), size * Vec3(1, -2, 0)});
  TreePrimitives items(mesh);
  const Skeleton nodes = buildSkeleton(items, false, {ObbFit::triangles, GetParam()});
  ASSERT_EQ(nodes.size(), 1U);
  EXPECT_EQ(nodes[0].count, 3U);
  EXPECT_EQ(nodes[0].right, 0U);
}

INSTANTIATE_TEST_SUITE_P(Rules, SplitRules, testing::Values(SplitRule::mean, SplitRule::median),
                         [](const auto& p) {
                           return p.param == SplitRule::mean ? "mean" : "median";
                         });

}  // namespace
}  // namespace corridor
