#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/queries/distance.h"
#include "collision/queries/distance_obb4.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/support/brute_force.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

/// Volumes are tested in the first body's frame. If this body's map shrinks, distances in the
/// body's frame are larger than in the world. Here the second map stretches by the same factor. The
/// relative map is computed with the transpose of the first map's matrix in place of the inverse.
/// So the computed relative map is a rotation, and its margins cover none of the shrinkage.
namespace corridor {
namespace {

constexpr double kShrink = 1e-4;

/// Triangles around a tiny mesh at the origin. Their distances from the tiny mesh differ by less
/// than the amount by which the map shrinks lengths.
struct CurvedShell {
  TriangleMesh around, speck;
  Transform X_WA, X_WB;
  double distance;

  explicit CurvedShell(std::mt19937_64& random) {
    std::uniform_real_distribution<double> real(-1, 1);
    const auto any = [&] {
      const double x = real(random), y = real(random), z = real(random);
      return Vec3(x, y, z);
    };
    const TriangleMesh point = [] {
      TriangleMesh mesh;
      test::add(mesh, Vec3::Zero(), Vec3::Zero(), Vec3::Zero());
      return mesh;
    }();
    for (int n = 0; n < 60; ++n) {
      const Vec3 out = any().normalized(), side = out.unitOrthogonal(), other = out.cross(side);
      TriangleMesh one;
      const double size = 0.05;
      if (n % 2)  // a thin one: its box is as near as the triangle itself
        test::add(one, out + size * side, out - size * side, out + size * other);
      else
        test::add(one, out + size * any(), out + size * any(), out + size * any());
      const double scale =
          (1 + 0.3 * kShrink * real(random)) / test::bruteForceDistance(one, {}, point, {});
      for (const Vec3& v : one.vertices) around.vertices.push_back(scale * v);
      const auto first = static_cast<std::uint32_t>(around.vertices.size()) - 3;
      around.triangles.push_back({first, first + 1, first + 2});
    }
    test::add(speck, 1e-7 * any(), 1e-7 * any(), 1e-7 * any());
    X_WA = test::anyPose(random, 1);
    X_WB = test::anyPose(random, 1);
    X_WA.m *= 1 - kShrink;
    X_WB.m /= 1 - kShrink;
    X_WB.t = X_WA.t;
    distance = test::bruteForceDistance(around, X_WA, speck, X_WB);
  }
};

template <class Tree>
void expectRight(const CurvedShell& shell, const Tree& a, const Tree& b) {
  QueryContext context;
  const double d = shell.distance;
  EXPECT_NEAR(corridor::distance(Posed(a, shell.X_WA), Posed(b, shell.X_WB), {}, context).distance,
              d, 1e-11 * d);
  EXPECT_TRUE(closerThan(Posed(a, shell.X_WA), Posed(b, shell.X_WB), d * (1 + 1e-9), context));
  EXPECT_FALSE(closerThan(Posed(a, shell.X_WA), Posed(b, shell.X_WB), d * (1 - 1e-9), context));
}

template <class Volume>
class ShrinkingMaps : public testing::Test {};
TYPED_TEST_SUITE(ShrinkingMaps, test::Volumes, test::VolumeNames);

TYPED_TEST(ShrinkingMaps, DistancesAreThoseInTheWorld) {
  std::mt19937_64 random(test::testSeed(20261125));
  for (int n = 0; n < 20; ++n) {
    const CurvedShell shell(random);
    expectRight(shell, VolumeTree<TypeParam>(shell.around), VolumeTree<TypeParam>(shell.speck));
  }
}

TEST(ShrinkingMapsOf, WideTrees) {
  std::mt19937_64 random(test::testSeed(20261126));
  for (int n = 0; n < 20; ++n) {
    const CurvedShell shell(random);
    expectRight(shell, Obb4Tree(shell.around), Obb4Tree(shell.speck));
  }
}

}  // namespace
}  // namespace corridor
