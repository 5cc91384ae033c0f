#include <random>
#include <set>

#include <gtest/gtest.h>

#include "collision/course/octree_interference.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/queries/interference.h"
#include "tests/support/brute_force.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

TEST(Octree, ListsEveryTriangleAndStopsUselessDivision) {
  std::mt19937_64 random(test::testSeed(31));
  const TriangleMesh mesh = test::soup(random, 500, 0.05);
  const Octree tree(mesh);
  std::set<std::uint32_t> listed;
  for (std::uint32_t i = 0; i < tree.triangles().size(); ++i) listed.insert(tree.meshTriangle(i));
  EXPECT_EQ(listed.size(), mesh.triangles.size());
  EXPECT_GT(tree.nodes().size(), 100U);
  TriangleMesh same{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 1)}, {}};
  same.triangles.assign(100, {0, 1, 2});
  EXPECT_LT(Octree(same, {8, 4}).triangles().size(), 100U << 12);
  TriangleMesh point{{Vec3(1, 2, 3)}, {{0, 0, 0}}};
  point.triangles.assign(100, {0, 0, 0});
  EXPECT_EQ(Octree(point).nodes().size(), 1U);
}

TEST(Octree, AgreesWithBruteForceUnderTwoMaps) {
  std::mt19937_64 random(test::testSeed(32));
  int touching = 0;
  for (int n = 0; n < 100; ++n) {
    const TriangleMesh meshA = test::soup(random, 40, 0.1), meshB = test::soup(random, 40, 0.1);
    const Octree a(meshA), b(meshB);
    const VolumeTree<Aabb> objects(meshB);
    Transform X_WA = test::anyPose(random, 1), X_WB = test::anyPose(random, 1);
    for (Transform* X : {&X_WA, &X_WB}) X->t += (n % 3 ? 0 : 1e6) * Vec3(1, 2, 3);
    QueryContext context;
    const bool expected = test::bruteForceTouch(meshA, X_WA, meshB, X_WB);
    ASSERT_EQ(interference(Posed(a, X_WA), Posed(b, X_WB), context).has_value(), expected) << n;
    ASSERT_EQ(interference(Posed(b, X_WB), Posed(a, X_WA), context).has_value(), expected) << n;
    ASSERT_EQ(interference(Posed(a, X_WA), Posed(objects, X_WB), context).has_value(), expected)
        << n;
    touching += expected;
  }
  EXPECT_GT(touching, 10);
  EXPECT_LT(touching, 90);
}

TEST(Octree, SharedWorkloads) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  QueryContext context;
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    const Octree a(w.a), b(w.b);
    const VolumeTree<Aabb> objects(w.b);
    int wrong = 0;
    const std::size_t step = test::isStressRun() ? 1 : name[0] == 'a' ? 20 : 25;
    for (std::size_t i = 0; i < w.poses.size(); i += step * test::kSlowdown) {
      wrong += interference(Posed(a), Posed(b, w.poses[i]), context).has_value() != (w.hit[i] == 1);
      wrong += interference(Posed(a), Posed(objects, w.poses[i]), context).has_value() !=
               (w.hit[i] == 1);
    }
    EXPECT_EQ(wrong, 0) << name;
  }
}

}  // namespace
}  // namespace corridor
