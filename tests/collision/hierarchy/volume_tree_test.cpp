#include "collision/hierarchy/volume_tree.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/queries/interference.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/tree_fault.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::kParams;
using test::soup;

/// One suite for every volume; each test runs with every way of building.
template <class Volume>
class VolumeTrees : public testing::Test {};
TYPED_TEST_SUITE(VolumeTrees, test::Volumes, test::VolumeNames);

TYPED_TEST(VolumeTrees, ContainWhatTheyHold) {
  std::mt19937_64 random(test::testSeed(1));
  for (const TreeParams& params : kParams)
    for (const double offset : {0.0, 1e6, 1e12})
      for (const double size : {1.0, 1e-7}) {
        TriangleMesh mesh = soup(random, 60, size);
        for (Vec3& v : mesh.vertices) v += Vec3(offset, 0, -offset);
        EXPECT_EQ(test::treeFault(VolumeTree<TypeParam>(mesh, params)), std::nullopt)
            << test::str(params) << " at " << offset << ", triangles of " << size;
      }
}

TYPED_TEST(VolumeTrees, NeedATriangleOrAPart) {
  for (const TreeParams& params : kParams) {
    EXPECT_THROW(VolumeTree<TypeParam>(TriangleMesh{}, params), std::invalid_argument);
    EXPECT_THROW(VolumeTree<TypeParam>(TriangleMesh{{Vec3::Zero()}, {{0, 0, 1}}}, params),
                 std::invalid_argument);
    EXPECT_THROW(VolumeTree<TypeParam>(TriangleMesh{{Vec3(0, NAN, 0)}, {{0, 0, 0}}}, params),
                 std::invalid_argument);
    EXPECT_THROW(VolumeTree<TypeParam>(std::vector<ConvexPart>{}, params), std::invalid_argument);
  }
}

TYPED_TEST(VolumeTrees, ContainPointsSegmentsAndExtremes) {
  std::mt19937_64 random(test::testSeed(2));
  TriangleMesh point{{Vec3(1, 2, 3)}, {{0, 0, 0}}};
  EXPECT_EQ(test::treeFault(VolumeTree<TypeParam>(point)), std::nullopt);
  EXPECT_LT(VolumeTree<TypeParam>(point).node(0).radius, 1e-13);
  TriangleMesh segment{{Vec3(0, 0, 0), Vec3(3, 4, 0)}, {{0, 1, 1}, {1, 0, 0}}};
  EXPECT_EQ(test::treeFault(VolumeTree<TypeParam>(segment)), std::nullopt);
  for (const int exponent : {-1060, -500, -340, 330, 500, 1000}) {
    TriangleMesh mesh = soup(random, 20, 0.3);
    for (Vec3& v : mesh.vertices)
      v = v.unaryExpr([&](double x) { return std::ldexp(x, exponent); });
    for (const TreeParams& params : kParams)
      EXPECT_EQ(test::treeFault(VolumeTree<TypeParam>(mesh, params)), std::nullopt)
          << exponent << " " << test::str(params);
  }
}

TYPED_TEST(VolumeTrees, IdenticalTriangles) {
  TriangleMesh mesh{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {}};
  mesh.triangles.assign(3'000, {0, 1, 2});
  for (const TreeParams& params : kParams) {
    const VolumeTree<TypeParam> tree(mesh, params);
    if (params.building == TreeBuilding::topDown) {
      EXPECT_EQ(tree.nodes().size(), 1U);
    } else {
      EXPECT_LE(tree.depth(), 14U) << "clustering of equals is balanced";
    }
  }
}

/// Triangles of size 2^-i around a point: every split at the mean separates only one triangle from
/// the others.
TYPED_TEST(VolumeTrees, DeepTreesNeedNoCallStack) {
  TriangleMesh mesh;
  for (int i = 0; i < 300; ++i) {
    const double s = std::ldexp(1.0, -i);
    test::add(mesh, Vec3(s, 0, 0), Vec3(s, s / 4, 0), Vec3(s, 0, s / 4));
  }
  for (const TreeParams& params : kParams) {
    const VolumeTree<TypeParam> tree(mesh, params);
    EXPECT_GT(
        tree.depth(),
        params.split == SplitRule::mean && params.building == TreeBuilding::topDown ? 50U : 8U);
    QueryContext context;
    EXPECT_TRUE(interference(Posed(tree), Posed(tree), context));
    EXPECT_FALSE(
        interference(Posed(tree), Posed(tree, {Mat3::Identity(), Vec3(0, 0, 2)}), context));
  }
}

TYPED_TEST(VolumeTrees, OverManyConvexParts) {
  std::mt19937_64 random(test::testSeed(3));
  const auto parts = test::parts(random, 40, 0.1);
  for (const TreeParams& params : kParams) {
    const VolumeTree<TypeParam> tree(parts, params);
    EXPECT_EQ(test::treeFault(tree), std::nullopt) << test::str(params);
    EXPECT_EQ(tree.nodes().size(), 79U);
    EXPECT_EQ(VolumeTree<TypeParam>(parts[0]).nodes().size(), 1U);
  }
}

TYPED_TEST(VolumeTrees, MedianSplitsAreBalanced) {
  std::mt19937_64 random(test::testSeed(4));
  const TriangleMesh mesh = soup(random, 1'000, 0.01);
  TreeParams params;
  params.split = SplitRule::median;
  // The depth is ⌈log2 n⌉ + 1, because the sizes of two halves differ by at most one.
  EXPECT_EQ(VolumeTree<TypeParam>(mesh, params).depth(),
            std::ceil(std::log2(static_cast<double>(mesh.triangles.size()))) + 1);
}

TYPED_TEST(VolumeTrees, RefitContainsTheMovedTriangles) {
  std::mt19937_64 random(test::testSeed(5));
  std::normal_distribution<double> normal;
  for (const TreeParams& params : kParams) {
    TriangleMesh mesh = soup(random, 100, 0.1), other = soup(random, 100, 0.1);
    VolumeTree<TypeParam> tree(mesh, params);
    const VolumeTree<TypeParam> b(other);
    for (int step = 0; step < 3; ++step) {
      for (Vec3& v : mesh.vertices) v += Vec3(0.3 * v[1], 0.1 * normal(random), 1e3 * (step == 2));
      tree.refit(mesh);
      EXPECT_EQ(test::treeFault(tree), std::nullopt) << test::str(params);
      QueryContext context;
      EXPECT_EQ(interference(Posed(tree), Posed(b), context).has_value(),
                interference(Posed(VolumeTree<TypeParam>(mesh)), Posed(b), context).has_value());
    }
    // If a tree is refitted to the mesh from which it was built, its volumes are as good as those
    // of a new tree.
    const VolumeTree<TypeParam> fresh(mesh, params);
    VolumeTree<TypeParam> again(mesh, params);
    again.refit(mesh);
    for (std::uint32_t i = 0; i < fresh.nodes().size(); ++i)
      EXPECT_LE(again.node(i).radius, fresh.node(i).radius * (1 + 1e-9) + 1e-9);
  }
}

TYPED_TEST(VolumeTrees, SharedMeshes) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  for (const char* name : {"panda_hand", "touching_boxes_B", "cylinder"}) {
    const TriangleMesh mesh =
        test::plainObj(*data / "collision" / "meshes" / (std::string(name) + ".obj"));
    for (const TreeParams& params : kParams)
      EXPECT_EQ(test::treeFault(VolumeTree<TypeParam>(mesh, params)), std::nullopt)
          << name << " " << test::str(params);
  }
}

}  // namespace
}  // namespace corridor
