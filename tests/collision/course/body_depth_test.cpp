// Tests of the bounds of the penetration depth, by closed forms and by the definition of the
// bounds: no translation by less than the lower bound separates the bodies, and the reported
// translation by the upper bound does.
#include "collision/course/body_depth.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/world/body_queries.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

Body solidCube(double half) {
  return {"cube", test::box(Vec3::Constant(-half), Vec3::Constant(half))};
}
Transform at(const Vec3& t) {
  return {Mat3::Identity(), t};
}

TEST(BodyDepth, BodiesThatAreApartHaveNone) {
  QueryContext context;
  const DepthBounds d = depthBounds(solidCube(1), solidCube(1), at({2.001, 0, 0}), {}, context);
  EXPECT_EQ(d.lower, 0);
  EXPECT_EQ(d.upper, 0);
  EXPECT_FALSE(d.deepest);
}

/// Cubes that overlap by 0.3 along x, and by more along y and z.
TEST(BodyDepth, CubesAlongTheirAxes) {
  QueryContext context;
  for (const double sign : {-1.0, 1.0}) {
    const Transform X_AB = at({1.7 * sign, 0.2, 0.1});
    const DepthBounds best = depthBounds(solidCube(1), solidCube(1), X_AB, {}, context);
    EXPECT_NEAR(best.upper, 0.3, 1e-4);
    EXPECT_GE(best.upper, 0.3 * (1 - 1e-15));
    EXPECT_NEAR((best.direction_A - Vec3(sign, 0, 0)).norm(), 0, 1e-9);
    EXPECT_LE(best.lower, 0.3);
    EXPECT_TRUE(best.deepest);
    DepthOptions options;
    options.directions = {Vec3(0, 5, 0)};
    const DepthBounds up = depthBounds(solidCube(1), solidCube(1), X_AB, options, context);
    EXPECT_NEAR(up.upper, 1.8, 1e-4);
    EXPECT_EQ(up.direction_A, Vec3(0, 1, 0));
    EXPECT_EQ(up.lower, best.lower);
  }
}

/// At any scale, the upper bound separates the cubes, or is infinite.
TEST(BodyDepth, TinyAndHugeCubes) {
  QueryContext context;
  for (const double h : {0x1p-1000, 1e-290, 1e-170, 0x1p-500, 1e-100, 1e100, 1e200, 0x1p1000})
    for (const Vec3& t : {Vec3(1.7, 0.2, 0.1), Vec3(-1.9, 0, 0)}) {
      const Body a = solidCube(h), b = solidCube(h);
      DepthOptions along;
      along.directions = {Vec3(1, 0, 0)};
      for (const DepthOptions& options : {DepthOptions{}, along}) {
        const DepthBounds d = depthBounds(a, b, at(h * t), options, context);
        ASSERT_GT(d.upper, 0) << h;
        if (d.upper == HUGE_VAL) continue;
        const Vec3 moved = h * t + (d.upper * (1 + 1e-12)) * d.direction_A;
        EXPECT_FALSE(interference(Posed(a), Posed(b, at(moved)), context)) << h << ", " << t[0];
      }
    }
}

/// A map that is nearly a rotation is used exactly as stored; it is not replaced by the nearest
/// rotation.
TEST(BodyDepth, MapsThatAreNearlyRotations) {
  QueryContext context;
  Transform X_AB = at({1.7, 0.2, 0.1});
  X_AB.m(0, 0) += 1e-7;  // the face at x = 0.7 moves by 1e-7
  const DepthBounds d = depthBounds(solidCube(1), solidCube(1), X_AB, {}, context);
  EXPECT_GE(d.upper, (0.3 + 1e-7) * (1 - 1e-12));
  EXPECT_NEAR(d.upper, 0.3 + 1e-7, 1e-4);
}

/// For two convex parts the bounds are close to those of `penetration`, but the upper bound may be
/// larger, because few directions are tried.
TEST(BodyDepth, ConvexParts) {
  QueryContext context;
  const Body a("a", placed(Box{Vec3::Constant(2)}, {})), ball("ball", placed(Sphere{0.5}, {}));
  const DepthBounds d = depthBounds(a, ball, at({1.3, 0.2, 0.1}), {}, context);
  EXPECT_NEAR(d.lower, 0.2, 1e-6);
  EXPECT_LE(d.lower, 0.2 * (1 + 1e-15));
  EXPECT_NEAR(d.upper, 0.2, 1e-4);
  EXPECT_GE(d.upper, 0.2 * (1 - 1e-15));
}

/// A ball is inside a solid cube, and does not touch the cube's surface.
TEST(BodyDepth, InsideASolidMesh) {
  QueryContext context;
  const Body a("a", test::box(Vec3::Constant(-1), Vec3::Constant(1)), true);
  const Body ball("ball", placed(Sphere{0.25}, {}));
  const DepthBounds d = depthBounds(a, ball, at({0.5, 0.1, 0}), {}, context);
  EXPECT_FALSE(d.deepest);
  EXPECT_NEAR(d.lower, 0.25, 1e-9);  // from the ball to the side x = 1
  EXPECT_LE(d.lower, 0.25);
  EXPECT_NEAR(d.upper, 0.75, 1e-4);  // the translation after which the ball is outside
  EXPECT_GE(d.upper, 0.75 * (1 - 1e-15));
}

/// Tests bodies that are not convex, at random poses, against the definition of the bounds.
TEST(BodyDepth, BoundsHoldForRandomTranslations) {
  std::mt19937_64 random(test::testSeed(23));
  std::uniform_real_distribution<double> real(-1, 1);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return Vec3(normal(random), normal(random), normal(random)).normalized();
  };
  QueryContext context;
  int touching = 0, wide = 0;
  for (int n = 0; n < 40; ++n) {
    const auto angle = [&](const Vec3& low, const Vec3& corner, const Vec3& high) {
      TriangleMesh mesh = test::box(low, corner);
      test::addBox(mesh, Vec3(low[0], corner[1] - 0.1, low[2]), high);
      return mesh;
    };
    const Body a("a", angle({-1, -1, -0.4}, {-0.5, 0, 0.4}, {1, 0.4, 0.4}));
    const Body b("b", angle({-0.5, -1, -0.3}, {0, 0.2, 0.3}, {1, 0.5, 0.3}));
    Transform X_AB;
    X_AB.m = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                 .normalized()
                 .toRotationMatrix();
    X_AB.t = Vec3(real(random), real(random), real(random));
    const DepthBounds d = depthBounds(a, b, X_AB, {}, context);
    const auto touch = [&](const Vec3& shift) {
      return interference(Posed(a), Posed(b, Transform{X_AB.m, X_AB.t + shift}), context)
          .has_value();
    };
    if (!touch(Vec3::Zero())) {
      EXPECT_EQ(d.upper, 0);
      continue;
    }
    ++touching;
    ASSERT_GT(d.upper, 0) << n;
    EXPECT_LE(d.lower, d.upper) << n;
    EXPECT_FALSE(touch(d.upper * (1 + 1e-12) * d.direction_A)) << n;
    EXPECT_TRUE(touch(0.999 * d.upper * d.direction_A)) << n << ": the bound is far too large";
    for (const double factor : {1.001, 1.3, 2.0, 5.0})
      EXPECT_FALSE(touch(factor * d.upper * d.direction_A)) << n << ", " << factor;
    wide += d.lower > 0.05;
    for (int k = 0; k < 30; ++k)
      EXPECT_TRUE(touch(0.999999 * d.lower * direction())) << n << ", " << k;
  }
  EXPECT_GT(touching, 15);
  EXPECT_GT(wide, 5);
}

TEST(BodyDepth, BadArguments) {
  QueryContext context;
  const Body a = solidCube(1);
  DepthOptions zero, infinite, coarse;
  zero.directions = {Vec3::Zero()};
  infinite.directions = {Vec3(HUGE_VAL, 0, 0)};
  coarse.accuracy = 1;
  for (const DepthOptions& options : {zero, infinite, coarse})
    EXPECT_THROW(depthBounds(a, a, {}, options, context), std::invalid_argument);
  EXPECT_THROW(depthBounds(a, a, at({NAN, 0, 0}), {}, context), std::invalid_argument);
  const Transform scaled{4 * Mat3::Identity(), Vec3(-4.9, 0, 0)};
  EXPECT_THROW(depthBounds(a, a, scaled, {}, context), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
