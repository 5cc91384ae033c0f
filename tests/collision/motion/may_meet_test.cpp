#include "collision/motion/may_meet.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/queries/distance.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;
using test::at;
using test::bodyOf;
using test::box;

/// A sphere reaches 0.3e-162 into a body. The distance of the sphere's centre from the body is
/// 1.6e-162, and the square of this distance is subnormal. The code once rounded this square to
/// that of 2.2e-162, and so reported the bodies as separated.
TEST(MayMeet, GapWhoseSquareIsSubnormal) {
  const double e = 1.6e-162, r = 1.9e-162;
  TriangleMesh a, b;
  add(a, Vec3::Zero(), Vec3(0, e, 0), Vec3(0, 0, e));
  add(b, Vec3(-r, 0, 0), Vec3(r, 0, 0), Vec3(0, 0, 0.1 * e));
  RelativeMotion still;
  still.X_AB.t = Vec3(-e, 0.2 * e, 0.1 * e);
  EXPECT_TRUE(mayMeet(bodyOf(a), sweptSphere(bodyOf(b), still), 0));
}

/// A motion along a wall that is ten times as long as the gap is wide. Only the component of the
/// motion across the gap may reduce the bound.
TEST(MayMeet, ASlideKeepsItsGap) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             bar = bodyOf(box(Vec3(-0.5, 0, 0), Vec3(0.5, 0, 0)));
  std::array<ScrewMotion, 2> screws;
  for (const double tilt : {0.0, 0.1}) {
    const RigidMotion slide =
        RigidMotion::spatial(at(Vec3(-5, -tilt, 0)), at(Vec3(5, tilt, 0)), {});
    const double bound =
        clearanceBound(wall, sweptSphere(bar, slide.relativeMotion(0.5, 0.5, screws)));
    EXPECT_NEAR(bound, 0.5 - tilt, 1e-12) << "the sphere's radius is 0.5";
    EXPECT_LE(bound, 0.5 - tilt);
  }
}

/// The lower bound must not exceed the distance at any sampled time. It must never be below the
/// isotropic bound, and must prove some motions for which the isotropic bound is 0.
TEST(MayMeet, RandomMotions) {
  std::mt19937_64 random(test::testSeed(66));
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&] {
    const double x = real(), y = real(), z = real();
    return Vec3(x, y, z);
  };
  QueryContext context;
  std::array<ScrewMotion, 2> screws;
  int proved = 0, sideways = 0;
  for (int n = 0; n < 3'000 / test::kSlowdown; ++n) {
    TriangleMesh mesh;
    for (int i = 0; i < 4; ++i) {
      const Vec3 c = 0.3 * vector();
      const Vec3 d = 0.3 * vector();
      add(mesh, c, d, 0.3 * vector());
    }
    const Body b = bodyOf(mesh), a = bodyOf(box(-0.5 * Vec3::Ones(), Vec3(0.5, 0.8, 2)));
    const auto quaternion = [&](double angle) {
      return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector().normalized()));
    };
    const RigidPose from{3 * vector(), quaternion(real(-3, 3))};
    const double length = std::pow(10.0, real(-1, 0.7));
    const RigidPose to{from.p + length * vector(), quaternion(length * real()) * from.q};
    const RigidMotion motion = RigidMotion::spatial(from, to, {});
    const double h = std::ldexp(0.5, -static_cast<int>(real(0, 4)));
    const RelativeMotion relative = motion.relativeMotion(0.5, h, screws);
    const SweptSphere sphere = sweptSphere(b, relative);
    const double bound = clearanceBound(a, sphere);
    if (!(bound > 0)) continue;
    ++proved;
    SweptSphere isotropic = sphere;
    isotropic.secondOrder = HUGE_VAL;
    const double without = clearanceBound(a, isotropic);
    EXPECT_LE(without, bound);
    sideways += without == 0;
    for (int k = -8; k <= 8; ++k) {
      const Transform X = motion.at(0.5 + h * k / 8);
      const double d =
          distance(Posed(a.binaryTree()), Posed(b.binaryTree(), X), {}, context).distance;
      ASSERT_GE(d, bound * (1 - 1e-12) - 1e-14) << n << " at " << k;
    }
  }
  EXPECT_GT(proved, 500 / test::kSlowdown);
  EXPECT_GT(sideways, 30 / test::kSlowdown);
  std::cout << proved << " proved, " << sideways << " of them only by the directional bound\n";
}

/// Both bodies move far, and nearly in the same way. Their common motion must not reduce the bound.
TEST(MayMeet, CommonMotionKeepsTheGap) {
  const Body bar = bodyOf(box(Vec3(-0.5, 0, 0), Vec3(0.5, 0, 0)));
  std::array<ScrewMotion, 2> screwsA, screwsB;
  for (const double nearer : {0.0, 0.1}) {
    const RigidMotion one = RigidMotion::spatial(at(Vec3(0, -5, 0)), at(Vec3(3, 5, 0)), {}),
                      other =
                          RigidMotion::spatial(at(Vec3(0, -3, 0)), at(Vec3(3, 7 - nearer, 0)), {});
    const SweptSphere a = sweptSphere(bar, one.relativeMotion(0.5, 0.5, screwsA)),
                      b = sweptSphere(bar, other.relativeMotion(0.5, 0.5, screwsB));
    const double bound = clearanceBound(a, b);
    EXPECT_NEAR(bound, 1 - nearer, 1e-12) << "the spheres' radii are 0.5";
    EXPECT_LE(bound, 1 - nearer);
    EXPECT_EQ(clearanceBound(b, a), bound);
  }
}

/// The lower bound must not exceed the distance at any sampled time if both bodies move.
TEST(MayMeet, RandomMotionsOfBoth) {
  std::mt19937_64 random(test::testSeed(67));
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  QueryContext context;
  std::array<ScrewMotion, 2> screwsA, screwsB;
  int proved = 0, sideways = 0;
  for (int n = 0; n < 6'000 / test::kSlowdown; ++n) {
    const Body a = bodyOf(test::blob(random, 4, 0.3, 0.3)),
               b = bodyOf(test::blob(random, 4, 0.3, 0.3));
    const auto [fromA, toA] = test::randomEdge(random);
    auto [fromB, toB] = test::randomEdge(random);
    if (n % 2) toB.p = fromB.p + (toA.p - fromA.p) + 0.1 * Vec3(real(), real(), real());
    const RigidMotion goesA = RigidMotion::spatial(fromA, toA, {}),
                      goesB = RigidMotion::spatial(fromB, toB, {});
    const double h = std::ldexp(0.5, -static_cast<int>(real(0, 4)));
    SweptSphere ballA = sweptSphere(a, goesA.relativeMotion(0.5, h, screwsA)),
                ballB = sweptSphere(b, goesB.relativeMotion(0.5, h, screwsB));
    const double bound = clearanceBound(ballA, ballB);
    if (!(bound > 0)) continue;
    ++proved;
    for (const double enough : {0.0, 0.3 * bound, 2 * bound}) {
      const double early = clearanceBound(ballA, ballB, enough);
      EXPECT_LE(early, bound);
      EXPECT_EQ(early > enough, bound > enough);
    }
    for (int k = -8; k <= 8; ++k) {
      const double t = 0.5 + h * k / 8;
      const double d = distance(Posed(a.binaryTree(), goesA.at(t)),
                                Posed(b.binaryTree(), goesB.at(t)), {}, context)
                           .distance;
      ASSERT_GE(d, bound * (1 - 1e-12) - 1e-14) << n << " at " << k;
    }
    ballA.secondOrder = HUGE_VAL;
    sideways += clearanceBound(ballA, ballB) == 0;
  }
  EXPECT_GT(proved, 1'000 / test::kSlowdown);
  EXPECT_GT(sideways, 100 / test::kSlowdown);
  std::cout << proved << " proved, " << sideways << " of them only by the directional bound\n";
}

}  // namespace
}  // namespace corridor
