#include "collision/course/test_costs.h"

#include <cmath>

#include <gtest/gtest.h>

#include "collision/course/cost_model.h"
#include "collision/queries/interference.h"
#include "collision/volumes/pair_tests.h"
#include "tests/support/meshes.h"

namespace corridor {
namespace {

/// Returns the surface of a cube as 12·n² triangles, bent a little.
TriangleMesh bentCube(int n) {
  TriangleMesh mesh = test::tessellatedCube(n);
  for (Vec3& p : mesh.vertices) p = p + 0.1 * Vec3(std::sin(p[1]), std::sin(p[2]), std::sin(p[0]));
  return mesh;
}

std::vector<Transform> posesAlong() {
  std::vector<Transform> poses;
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.3 * i;
    Transform X;
    X.m << std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1;
    X.t = Vec3(1.6 + 0.1 * i, 0.2, 0.3);
    poses.push_back(X);
  }
  return poses;
}

/// The recorded tests are those of `interference`, pose by pose.
TEST(TestCosts, RecordsTheTestsOfQueries) {
  const VolumeTree<Obb> a(bentCube(6)), b(bentCube(5));
  const auto poses = posesAlong();
  const RecordedTests tests = recordedTests<StandardOverlap>(a, b, poses, 1'000'000);
  int contacts = 0;
  for (std::uint32_t i = 0; i < poses.size(); ++i) {
    QueryContext context;
    contacts += interference(Posed(a), Posed(b, poses[i]), context).has_value();
    const auto here = [&](const RecordedTest& t) { return t.pose == i; };
    EXPECT_EQ(std::ranges::count_if(tests.boxes, here), context.counters.boxTests) << i;
    EXPECT_EQ(std::ranges::count_if(tests.leaves, here), context.counters.primitiveTests) << i;
  }
  EXPECT_GT(contacts, 2);
  EXPECT_LT(contacts, 12);
}

TEST(TestCosts, RecordsNoMoreThanTheLimit) {
  const VolumeTree<BoundingSphere> a(bentCube(6)), b(bentCube(5));
  const auto poses = posesAlong();
  const RecordedTests all = recordedTests<StandardOverlap>(a, b, poses, 1'000'000);
  const std::size_t count = all.boxes.size() + all.leaves.size();
  for (const std::size_t most : {std::size_t{1}, std::size_t{100}, count - 1, count}) {
    const RecordedTests some = recordedTests<StandardOverlap>(a, b, poses, most);
    EXPECT_EQ(some.boxes.size() + some.leaves.size(), most);
  }
}

/// Queries that touch nothing and end at the root have no triangle test, so this cost is unknown.
TEST(TestCosts, CostsOfTestsThatOccur) {
  const VolumeTree<Aabb> a(bentCube(6)), b(bentCube(5));
  const TestCosts near = testCosts<StandardOverlap>(a, b, posesAlong());
  ASSERT_TRUE(near.box && near.triangle);
  EXPECT_GT(*near.box, 0);
  EXPECT_GT(*near.triangle, 0);
  Transform away;
  away.t = Vec3(100, 0, 0);
  const TestCosts far = testCosts<StandardOverlap>(a, b, {{away}});
  EXPECT_TRUE(far.box);
  EXPECT_FALSE(far.triangle);
  EXPECT_FALSE(testCosts<StandardOverlap>(a, b, {}).box);
}

/// The share of the traversal is determined even for proportional counts, where two costs are not.
TEST(TestCosts, TraversalShareOfProportionalCounts) {
  std::vector<QueryCost> queries;
  for (int i = 1; i < 10; ++i) {
    const double v = 10.0 * i, p = 5.0 * i;
    queries.push_back({v, p, 40 + v * (12 + 3) + p * 90});
  }
  EXPECT_NEAR(traversalShare(queries, {12, 90}, 40), 3, 1e-9);
  EXPECT_NEAR(traversalShare(queries, {20, 90}, 40), -5, 1e-9);
  EXPECT_EQ(traversalShare({{0, 0, 50}}, {12, 90}, 40), 0);
}

}  // namespace
}  // namespace corridor
