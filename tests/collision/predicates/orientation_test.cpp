#include "collision/predicates/orientation.h"

#include <array>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Point = std::array<Rational, 3>;

Point mapped(const MappedPoint& point) {
  Point x;
  for (int i = 0; i < 3; ++i) {
    x[i] = Rational(point.X.t[i]);
    for (int k = 0; k < 3; ++k) x[i] += Rational(point.X.m(i, k)) * Rational(point.p[k]);
  }
  return x;
}

int rationalSign(const std::array<MappedPoint, 4>& points) {
  const Point origin = mapped(points[0]);
  Point d[3];
  for (int n = 0; n < 3; ++n) {
    d[n] = mapped(points[n + 1]);
    for (int i = 0; i < 3; ++i) d[n][i] -= origin[i];
  }
  const Rational det = d[2][0] * (d[0][1] * d[1][2] - d[0][2] * d[1][1]) +
                       d[2][1] * (d[0][2] * d[1][0] - d[0][0] * d[1][2]) +
                       d[2][2] * (d[0][0] * d[1][1] - d[0][1] * d[1][0]);
  return det.sign();
}

/// Four nearly coplanar points, each under one of two maps, far from the origin. The sign must be
/// right, although the rounded images would give a wrong one.
TEST(OrientationSign, NearlyCoplanarPointsUnderTwoMaps) {
  std::mt19937_64 random(test::testSeed(20261124));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  const auto point = [&] { return Vec3(real(), real(), real()); };
  const auto rotation = [&] {
    return Mat3(Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix());
  };
  int roundedWrongly = 0, positive = 0, negative = 0;
  for (int n = 0; n < 5'000; ++n) {
    const double far = std::ldexp(1.0, static_cast<int>(10 * real()));
    const Transform X{rotation(), far * point()}, Y{rotation(), far * point()};
    const Transform X_YX{Y.m.transpose() * X.m, Y.m.transpose() * (X.t - Y.t)};
    std::array<Vec3, 4> p = {point(), point(), point(), {}};
    p[3] = p[0] + real() * (p[1] - p[0]) + real() * (p[2] - p[0]);
    const bool twoMaps = n % 2 == 0;
    if (twoMaps) p[3] = X_YX * p[3];
    const std::array<MappedPoint, 4> points = {
        {{X, p[0]}, {X, p[1]}, {X, p[2]}, {twoMaps ? Y : X, p[3]}}};
    const int expected = rationalSign(points);
    ASSERT_EQ(orientationSign(points[0], points[1], points[2], points[3]), expected) << n;
    ASSERT_EQ(orientationSign(points[1], points[0], points[2], points[3]), -expected) << n;
    positive += expected > 0;
    negative += expected < 0;
    const Vec3 o = X * p[0], q = X * p[1] - o, r = X * p[2] - o, s = points[3].X * p[3] - o;
    const double det = s.dot(q.cross(r));
    roundedWrongly += (det > 0) - (det < 0) != expected;
  }
  EXPECT_GT(positive, 1'000);
  EXPECT_GT(negative, 1'000);
  EXPECT_GT(roundedWrongly, 250) << "the cases must be hard";
}

/// A point that is off a plane by the least positive double must not be treated as a point in this
/// plane.
TEST(OrientationSign, OneSubnormalOffThePlane) {
  const Transform X;
  const MappedPoint o{X, Vec3::Zero()}, x{X, Vec3::UnitX()}, y{X, Vec3::UnitY()};
  EXPECT_EQ(orientationSign(o, x, y, {X, Vec3(0.3, 0.4, 0)}), 0);
  EXPECT_EQ(orientationSign(o, x, y, {X, Vec3(0.3, 0.4, 0x1p-1074)}), 1);
  EXPECT_EQ(orientationSign(o, x, y, {X, Vec3(0.3, 0.4, -0x1p-1074)}), -1);
}

}  // namespace
}  // namespace corridor
