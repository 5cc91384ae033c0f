// Tests whether two triangles are separated during a whole time interval. One of them is at rest; a
// kinematic chain moves the other.
#include "collision/motion/moving_triangles.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/chain_motion.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::ChainMotion;

MovingPairAnswer decide(const Triangle& a, const Triangle& b, ChainMotion& motion) {
  return decideMovingTriangles(a, b, motion.relativeMotion(0, 0.5, 0.5), 0);
}

/// A revolute joint rotates the direction of a prismatic joint. To first order, the top corner of
/// triangle b moves along x, parallel to triangle a. At the ends of the interval this corner has
/// risen by 0.2·sin(0.1), through a.
TEST(MovingTriangles, ASlideThatIsTurnedRises) {
  ChainMotion motion({{false, Vec3::UnitZ(), Vec3::Zero(), -0.1, 0.1},
                      {true, Vec3::UnitX(), Vec3::Zero(), -0.2, 0.2}});
  const Triangle b = {Vec3(0, 0, 0), Vec3(-0.01, -0.01, 0), Vec3(0.01, -0.01, 0)};
  const auto separated = [&](double height) {
    return decide({Vec3(-5, height, -5), Vec3(5, height, -5), Vec3(0, height, 5)}, b, motion)
        .separated;
  };
  EXPECT_FALSE(separated(0.01));
  EXPECT_FALSE(separated(0.0199));
  EXPECT_TRUE(separated(0.022));
}

/// Triangle a is large, and stands across the path of triangle b. Along the normal of a, b moves
/// farther than its distance from a. So the two triangles meet, and must not be reported as
/// separated.
TEST(MovingTriangles, TrianglesThatMeetAreNotSeparated) {
  std::mt19937_64 random(test::testSeed(26));
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&] { return Vec3(real(), real(), real()); };
  int meet = 0, separated = 0;
  const int count = test::casesOf(3'000, 5'000);
  for (int n = 0; n < count; ++n) {
    const double size = std::pow(10.0, -(n / 4 % 4));
    std::vector<ChainMotion::Joint> joints(1 + static_cast<std::size_t>(n % 4));
    for (ChainMotion::Joint& joint : joints) {
      joint = {n % 3 && real() > 0.3, vector(), vector(), real(), 0};
      joint.to = joint.from + size * real();
    }
    ChainMotion motion(joints);
    const Vec3 where = vector(), normal = vector().normalized();
    const Triangle b = {where, where + 0.1 * vector(), where + 0.1 * vector()};
    const auto top = [&](long double t) {
      ChainMotion::Vec3L highest = ChainMotion::Vec3L::Zero();
      for (int i = 0; i < 3; ++i) {
        const ChainMotion::Vec3L x = motion.pose(t) * b[i].cast<long double>();
        if (i == 0 || x.dot(normal.cast<long double>()) > highest.dot(normal.cast<long double>()))
          highest = x;
      }
      return Vec3(highest.cast<double>());
    };
    const double middle = normal.dot(top(0.5L));
    Vec3 highest = top(0);
    for (int k = 1; k <= 64; ++k)
      if (const Vec3 x = top(k / 64.0L); normal.dot(x) > normal.dot(highest)) highest = x;
    const double rise = normal.dot(highest) - middle;
    if (rise < 1e-9) continue;
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    const auto across = [&](double height) {
      const Vec3 c = highest + (height - normal.dot(highest)) * normal;
      return Triangle{c - 50 * u - 50 * v, c + 50 * u - 50 * v, c + 50 * v};
    };
    for (const double share : {0.3, 0.9, 0.999}) {
      ASSERT_FALSE(decide(across(middle + share * rise), b, motion).separated) << n << ' ' << share;
      ++meet;
    }
    separated += decide(across(middle + 1.5 * rise), b, motion).separated;
  }
  EXPECT_GT(meet, count);
  EXPECT_GT(separated, count / 5) << "an answer that never separates can't be wrong";
}

}  // namespace
}  // namespace corridor
