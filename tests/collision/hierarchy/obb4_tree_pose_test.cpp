// Compares `Obb4TreePose::apart` with distances computed on the binary trees, in double.
#include "collision/hierarchy/obb4_tree_pose.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/queries/distance.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::testSeed;

class Obb4TreePoses : public test::EveryTarget {
 protected:
  double real(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  Vec3 vector() {
    const double x = real(-1, 1), y = real(-1, 1), z = real(-1, 1);
    return {x, y, z};
  }
  bool apart(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
             const Transform& X_WB, double pad) {
    return Obb4TreePose(Obb4Tree(a), X_WA, Obb4Tree(b), X_WB, pad).apart;
  }
  double distanceOf(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                    const Transform& X_WB) {
    return distance(Posed(ObbTree(a), X_WA), Posed(ObbTree(b), X_WB), {}, context_).distance;
  }

  std::mt19937_64 random_{testSeed(51)};
  QueryContext context_;
};

INSTANTIATE_TEST_SUITE_P(Targets, Obb4TreePoses, testing::ValuesIn(test::simdTargets()),
                         test::targetName);

/// A corner of one box is at a known gap from a face of another box. The boxes of the trees are
/// tight there, so a margin that is too small or too large makes the test fail. Some maps are not
/// rotations, and some meshes are far from their frames' origins.
TEST_P(Obb4TreePoses, CornersAtFaces) {
  int apartPairs = 0;
  for (int n = 0; n < 3000; ++n) {
    const double unit = std::ldexp(1.0, n % 5 == 0 ? 200 : n % 5 == 1 ? -200 : 0);
    const double noise = n % 3 ? 0 : std::pow(10.0, real(-13, -3));
    const double gap = unit * (n % 7 ? std::pow(10.0, real(-9, 0)) : -std::pow(10.0, real(-9, -3)));
    Vec3 half[2], offset[2];
    Transform X[2];
    TriangleMesh mesh[2];
    for (int i = 0; i < 2; ++i) {
      half[i] = Vec3(real(0.1, 1), real(0.1, 1), real(0.1, 1)) *
                std::exp2(i == 0 ? 0.0 : std::round(real(-10, 3)));
      offset[i] = n % 2 ? Vec3(Vec3::Zero()) : Vec3(100 * vector());
      X[i] = test::anyPose(random_, 0);
      for (int k = 0; k < 3; ++k) X[i].m.col(k) += noise * vector();
    }
    const int face = n % 3;
    const Vec3 normal = X[0].m.inverse().transpose().col(face).normalized();
    const Vec3 onFace =
        X[0].m *
        (half[0].cwiseProduct(0.9 * vector()).cwiseProduct(Vec3::Ones() - Vec3::Unit(face)) +
         half[0][face] * Vec3::Unit(face));
    const Vec3 corner = (X[1].m.transpose() * normal)
                            .cwiseSign()
                            .cwiseProduct(half[1]);  // the corner farthest along the normal
    const Vec3 center = onFace + (gap / unit) * normal + X[1].m * corner;
    X[0].t = vector();
    X[1].t = X[0].t + center;
    for (int i = 0; i < 2; ++i) {
      X[i].t = unit * (X[i].t - X[i].m * offset[i]);
      mesh[i] = test::box(unit * (offset[i] - half[i]), unit * (offset[i] + half[i]));
    }
    const int a = n / 3 % 2, b = 1 - a;
    const double d = distanceOf(mesh[a], X[a], mesh[b], X[b]);
    const double size = unit * (half[0].sum() + half[1].sum());
    for (const double pad : {d * (1 + 1e-9) + 1e-12 * size, 2 * d, HUGE_VAL})
      ASSERT_FALSE(apart(mesh[a], X[a], mesh[b], X[b], pad)) << n << ": " << d << ", " << pad;
    if (d == 0) {
      ASSERT_FALSE(apart(mesh[a], X[a], mesh[b], X[b], 0)) << n;
    }
    // For rotations, margins are 180 unit roundoffs of the sizes and of the centres' distance. A
    // gap of more than eight times these margins must be detected, and the lower bound of the
    // distance must exceed half of the gap.
    if (noise == 0 && d > 8 * 180 * 0x1p-24 * size) {
      ASSERT_TRUE(apart(mesh[a], X[a], mesh[b], X[b], d / 2)) << n << ": " << d;
      ASSERT_TRUE(apart(mesh[a], X[a], mesh[b], X[b], 0)) << n << ": " << d;
      ++apartPairs;
    }
  }
  EXPECT_GT(apartPairs, 600);
}

/// Soups whose distances are about as large as their sizes. Some pairs are separated by their
/// bounding spheres, others by their boxes.
TEST_P(Obb4TreePoses, Soups) {
  int apartAtAll = 0;
  for (int n = 0; n < 500; ++n) {
    const TriangleMesh a = test::soup(random_, 5, 0.3), b = test::soup(random_, 5, 0.3);
    const Transform X_WA = test::anyPose(random_, 1), X_WB = test::anyPose(random_, n % 2 ? 2 : 5);
    const double d = distanceOf(a, X_WA, b, X_WB);
    if (d == 0) {
      ASSERT_FALSE(apart(a, X_WA, b, X_WB, 0)) << n;
    }
    for (const double share : {1 + 1e-9, 1.5, 10.0})
      ASSERT_FALSE(apart(a, X_WA, b, X_WB, share * d + 1e-12)) << n << ": " << d;
    apartAtAll += apart(a, X_WA, b, X_WB, 0);
  }
  EXPECT_GT(apartAtAll, 200);
}

/// Under maps that are far from rigid, or not finite, nothing may be separated.
TEST_P(Obb4TreePoses, NothingIsSeparatedUnderOtherMaps) {
  const TriangleMesh cube = test::box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
  const Transform far{Mat3::Identity(), Vec3(10, 0, 0)};
  ASSERT_TRUE(apart(cube, {}, cube, far, 0));
  for (int i = 0; i < 9; ++i)
    for (const double wrong : {0.5, std::nan(""), HUGE_VAL, 1e200}) {
      Transform X = far;
      X.m(i / 3, i % 3) += wrong;
      EXPECT_FALSE(apart(cube, {}, cube, X, 0)) << i << ' ' << wrong;
      EXPECT_FALSE(apart(cube, X, cube, {}, 0)) << i << ' ' << wrong;
    }
}

}  // namespace
}  // namespace corridor
