// Tests of signed distances against closed forms, on both sides of contact.
#include "collision/course/signed_distance.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Touching;

Transform randomPose(Touching& make) {
  const Eigen::Quaterniond q(make.real(), make.real(), make.real(), make.real());
  return {q.normalized().toRotationMatrix(), make.vector()};
}

void expectSigned(const SignedDistance& d, double expected, double tolerance) {
  EXPECT_NEAR(d.distance, expected, tolerance);
  EXPECT_LE(d.lower, expected + 1e-15);
  EXPECT_GE(d.upper, expected - 1e-15);
  EXPECT_LE(d.lower, d.distance);
  EXPECT_LE(d.distance, d.upper);
  EXPECT_NEAR((d.p_WB - d.p_WA - d.distance * d.normal_W).norm(), 0, 1e-9);
}

/// For two spheres, the signed distance is the distance of the centres minus the radii.
TEST(SignedDistance, Spheres) {
  Touching make(test::testSeed(41));
  for (int n = 0; n < 200; ++n) {
    const double ra = make.real(0.1, 1), rb = make.real(0.1, 1);
    const Transform X_WA = randomPose(make);
    const Vec3 normal = make.vector().normalized();
    for (const double gap : {1.0, 1e-3, 1e-9, -1e-9, -1e-3, -0.5 * std::min(ra, rb)}) {
      const Transform X_WB = {Mat3::Identity(), X_WA.t + (ra + rb + gap) * normal};
      const double expected = (X_WB.t - X_WA.t).norm() - ra - rb;
      const ConvexPart a{{Vec3::Zero()}, ra}, b{{Vec3::Zero()}, rb};
      const SignedDistance d = signedDistance({a, X_WA}, {b, X_WB});
      // The bounds of a depth differ by up to 2^-42 of the largest coordinate, which is some 5 m.
      expectSigned(d, expected, 0x1p-39 + 1e-9 * std::abs(gap));
      EXPECT_NEAR((d.normal_W - normal).norm(), 0, 1e-6) << gap;
    }
  }
}

/// For two cubes with parallel axes, the signed distance is the gap along the only axis along which
/// they are apart; if there is none, it is minus the least overlap along an axis.
TEST(SignedDistance, Cubes) {
  Touching make(test::testSeed(42));
  const ConvexPart cube = placed(Box{Vec3::Constant(2)}, {});
  for (int n = 0; n < 100; ++n) {
    const Transform X_WA = randomPose(make);
    for (const double gap : {1.5, 1e-6, -1e-6, -0.25}) {
      const Vec3 offset(2 + gap, make.real(-0.5, 0.5), make.real(-0.5, 0.5));
      const Transform X_WB = {X_WA.m, X_WA.t + X_WA.m * offset};
      const SignedDistance d = signedDistance({cube, X_WA}, {cube, X_WB});
      EXPECT_NEAR(d.distance, gap, 0x1p-39 + 1e-9 * std::abs(gap));
      EXPECT_LE(d.lower, gap + 1e-14);
      EXPECT_GE(d.upper, gap - 1e-14);
      EXPECT_NEAR(d.normal_W.dot(X_WA.m.col(0)), 1, 1e-6);
    }
  }
}

/// For sets that just touch, the bounds must enclose 0, although rounding may separate the sets or
/// make them overlap.
TEST(SignedDistance, TouchingSets) {
  Touching make(test::testSeed(43));
  for (int n = 0; n < 300; ++n) {
    const auto a = make.feature(test::Shape::box), b = make.feature(test::Shape::capsule);
    const Vec3 normal = make.vector().normalized(), x = make.vector();
    const Transform X_WA = make.pose(a, x, normal), X_WB = make.pose(b, x, -normal);
    const SignedDistance d = signedDistance({a.part, X_WA}, {b.part, X_WB});
    EXPECT_LE(d.lower, 1e-14) << n;
    EXPECT_GE(d.upper, -1e-14) << n;
    EXPECT_NEAR(d.distance, 0, 1e-12) << n;
  }
}

}  // namespace
}  // namespace corridor
