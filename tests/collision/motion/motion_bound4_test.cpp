// Compares the motion bounds for the boxes of a 4-wide OBB tree with the bounds of `motionBound`
// for the boxes' bounding spheres.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/collision/motion/motion_bound4_test.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/motion/motion_bound4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

void travelsOf(const Obb4Tree& b, const RelativeMotion& relative, double unitA, double margin,
               double tolerance, std::vector<Obb4MotionBound>& bounds, std::vector<unsigned>& far) {
  MotionBound4 bound(b, relative, unitA, margin, tolerance);
  for (const Obb4Tree::Node& node : b.nodes()) {
    bounds.push_back(bound.of(node));
    far.push_back(bound.of(node).far);
  }
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "tests/collision/queries/every_target.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

HWY_EXPORT(travelsOf);

class Obb4MotionBounds : public test::EveryTarget {};
INSTANTIATE_TEST_SUITE_P(Simd, Obb4MotionBounds, testing::ValuesIn(test::simdTargets()),
                         &test::targetName);

TEST_P(Obb4MotionBounds, AreThoseOfTheSpheres) {
  std::mt19937_64 random(test::testSeed(63));
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&] {
    const double x = real(), y = real(), z = real();
    return Vec3(x, y, z);
  };
  using Kind = ScrewMotion::Kind;
  int bending = 0;
  for (int n = 0; n < 2'000 / test::kSlowdown; ++n) {
    TriangleMesh mesh;
    const Vec3 offset = std::pow(10.0, real(-2, 3)) * vector();
    for (int i = 0; i < 20; ++i) {
      const Vec3 p = offset + vector();
      test::add(mesh, p, p + 0.2 * vector(), p + 0.2 * vector());
    }
    const Obb4Tree tree(mesh);
    RelativeMotion w;
    w.X_AB.m = Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix();
    w.X_AB.t = 3 * vector();
    std::vector<ScrewMotion> screws;
    const double size = std::pow(10.0, real(-4, 0.5));
    for (int j = 0; j <= n % 5; ++j) {
      const double kind = real(0, 1);
      ScrewMotion screw{.kind = kind < 0.5   ? Kind::revolute
                                : kind < 0.9 ? Kind::prismatic
                                             : Kind::spherical,
                        .axis = vector().normalized(),
                        .point = 3 * vector(),
                        .amount = size * real(0, 1),
                        .tube = n % 3 ? 0 : size * real(0, 0.1)};
      if (screw.kind == Kind::spherical || real() > 0.6) screw.amount = 0;
      if (screw.kind != Kind::spherical && n % 4 == 3) screw.deviation = size * real(0, 0.1);
      if (screw.kind == Kind::prismatic) w.linear += screw.amount * screw.axis;
      if (screw.kind == Kind::revolute) {
        w.linear += screw.amount * screw.axis.cross(w.X_AB.t - screw.point);
        w.angular += screw.amount * screw.axis;
      }
      screws.push_back(screw);
    }
    w.screws = screws;
    w.speed = roundedUp(w.linear.norm()), w.angle = roundedUp(w.angular.norm());
    if (n % 2) w.fixedError = real(0, 0.01), w.reachError = real(0, 0.01);
    const double unitA = std::ldexp(1.0, n % 9 - 4), margin = n % 4 ? 0 : real(0, 0.1),
                 tolerance = size * real(0, 1);
    double turned = w.angle;
    for (const ScrewMotion& screw : screws) turned += screw.amount + screw.deviation + screw.tube;
    const double rounding = 16 * kUnit * (w.X_AB.t.cwiseAbs().sum() + 12 * tree.reach() + w.speed) *
                            (1 + turned) * (1 + turned);
    std::vector<Obb4MotionBound> bounds;
    std::vector<unsigned> far;
    HWY_DYNAMIC_DISPATCH(travelsOf)(tree, w, unitA, margin, tolerance, bounds, far);
    for (std::size_t i = 0; i < bounds.size(); ++i)
      for (int lane = 0; lane < 4; ++lane) {
        const Obb4Tree::Node& node = tree.nodes()[i];
        if (node.child[lane] == Obb4Tree::kNone) continue;
        const auto three = [&](const float(&rows)[3][4]) {
          return Vec3(tree.length() * Vec3(rows[0][lane], rows[1][lane], rows[2][lane]));
        };
        Vec3 center;
        for (int k = 0; k < 3; ++k) center[k] = node.vectors[k][Obb4::kCenter][lane];
        const Vec3 y = w.X_AB.m * (tree.origin() + tree.length() * center);
        const MotionBound is = motionBound(w, y + w.X_AB.t, three(node.half).norm());
        const Obb4MotionBound& computed = bounds[i];
        // The bound must exceed the value in exact arithmetic by at least 2^-16 of this value. The
        // excess may be at most 2^-14 of this value, plus the kernel's allowance for the rounding
        // of the lever, once per joint.
        const auto covers = [&](float bound, double x) {
          return bound >= unitA * x * (1 + 0x1p-16) &&
                 bound <= unitA * (x * (1 + 0x1p-14) + rounding);
        };
        ASSERT_TRUE(covers(computed.isotropic[lane], is.isotropic)) << n;
        ASSERT_TRUE(covers(computed.secondOrderAcross[lane], is.secondOrderAcross)) << n;
        ASSERT_TRUE(covers(computed.secondOrder[lane], is.secondOrder)) << n;
        ASSERT_TRUE(covers(computed.pad[lane], is.pad + margin)) << n;
        bending += computed.secondOrderAcross[lane] > 0;
        const Vec3 first = unitA * (w.linear + w.angular.cross(y));
        for (int k = 0; k < 3; ++k) {
          ASSERT_NEAR(computed.linear[k][lane], first[k],
                      0x1p-23 * std::abs(first[k]) + rounding * unitA);
          ASSERT_NEAR(computed.angular[k], w.angular[k], 0x1p-23 * std::abs(w.angular[k]));
        }
        if (is.isotropic > tolerance) {
          ASSERT_TRUE(far[i] >> lane & 1) << n;
        }
      }
  }
  EXPECT_GT(bending, 100);
}

}  // namespace
}  // namespace corridor
#endif
