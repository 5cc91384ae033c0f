// Tests the kernel of moving boxes against its contract (obb4.h). Boxes that just meet within the
// interval must not be separated, whatever the axis along which they meet. Boxes that stay a little
// apart must be separated.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "collision/core/transform.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/collision/volumes/moving_boxes_test.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/volumes/overlap_obb4_moving-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

unsigned openBoxes(const Obb4& a, const Obb4& b, const Obb4Pose& pose,
                   const Obb4MotionBound& bound) {
  alignas(64) float keys[16];
  return movingBoxes(a, b, pose, bound, keys).open;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <Eigen/Geometry>

#include "tests/collision/queries/every_target.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

HWY_EXPORT(openBoxes);

using Random = std::mt19937_64;

double real(Random& random, double low = -1, double high = 1) {
  return std::uniform_real_distribution(low, high)(random);
}
Vec3 vector(Random& random) {
  const double x = real(random), y = real(random), z = real(random);
  return Vec3(x, y, z);
}
Mat3 rotation(Random& random) {
  const Vec3 v = vector(random);
  return Eigen::Quaterniond(real(random), v[0], v[1], v[2]).normalized().toRotationMatrix();
}
double sign(double x) {
  return x < 0 ? -1 : 1;
}

enum class By { directions, isotropic };

/// Four pairs of boxes: the i-th box of a with the i-th box of b. At one end of the interval the
/// gap of each pair, along one of the 15 axes, is `gap` times the sizes of the pair. The boxes move
/// towards each other as far as the contract of the kernel allows.
struct Pairs {
  Obb4 a = {}, b = {};
  Obb4Pose pose = {};
  Obb4MotionBound bound = {};
  bool steady = true;  // whether no cross product of two edges is short

  Pairs(Random& random, int n, By by, double gap, bool beyond, double most = 2) {
    const auto f = [](double x) { return static_cast<float>(x); };
    // The displacement of each corner is bounded separately. For large rotations the bound exceeds
    // the displacement of every single corner.
    const double spin = std::pow(10.0, real(random, -3, most));
    const Mat3 M = rotation(random);
    const Vec3 angular = (spin * vector(random)).cast<float>().cast<double>();
    const double scale = std::ldexp(1.0, n % 7 - 3);
    pose.scale = f(scale);
    // Rounding to floats: entries of M are off by u, centres by 4u·(3 + 3s). The margins of
    // `Obb4TreePose` cover both.
    pose.relative = f(180 * 0x1p-24 + 20 * 0x1p-24);
    pose.absoluteMargin = f(0x1p-24 * (33 * scale + 6 + 20));
    for (int k = 0; k < 3; ++k) {
      bound.angular[k] = f(angular[k]);
      for (int l = 0; l < 3; ++l) pose.turn[l][k] = f(M(k, l));
    }
    for (int i = 0; i < 4; ++i) {
      const Mat3 A = rotation(random), B = rotation(random);
      Vec3 ea = vector(random).cwiseAbs(), eb = vector(random).cwiseAbs();
      if (n % 3 == 1) eb *= std::pow(10.0, real(random, -3, 0));
      if (n % 3 == 2) ea *= std::pow(10.0, real(random, -3, 0));
      for (int j = 0; j < 3; ++j) {
        a.half[j][i] = f(ea[j]), b.half[j][i] = f(eb[j]);
        for (int k = 0; k < 3; ++k)
          a.vectors[k][j][i] = f(A(k, j)), b.vectors[k][j][i] = f(B(k, j));
      }
      const Mat3 U = M * B;
      const int axis = (n / 7 + i) % 15;
      Vec3 normal = axis < 3   ? Vec3(A.col(axis))
                    : axis < 6 ? Vec3(U.col(axis - 3))
                               : Vec3(A.col((axis - 6) / 3).cross(U.col((axis - 6) % 3)));
      steady = steady && normal.norm() > 0.3;
      normal.normalize();
      Vec3 linear = real(random, 0, 2) * vector(random);
      if (linear.dot(normal) > 0) linear = -linear;
      if (by == By::isotropic) linear = -2 * normal;
      linear = Vec3(linear.cast<float>().cast<double>());
      const double secondOrderAcross = beyond ? real(random, 0, 1) / spin : 0,
                   secondOrder = beyond ? real(random, 0, 1) : 0,
                   pad = beyond ? real(random, 0, 0.1) : 0;
      const double up = 1 + 0x1p-15;
      bound.secondOrderAcross[i] = f(secondOrderAcross * up),
      bound.secondOrder[i] = f(secondOrder * up);
      bound.pad[i] = f(pad * up);
      for (int k = 0; k < 3; ++k) bound.linear[k][i] = f(linear[k]);
      const double isotropic = real(random, 0, 0.3);
      bound.isotropic[i] = by == By::isotropic ? f(isotropic * up) : 1e30F;
      // The moved box b at s = 1 (s = −1 is symmetric): its axes to first order, and the
      // displacement of its centre.
      Mat3 moved = scale * U * eb.asDiagonal();
      Vec3 goes = Vec3::Zero();
      if (by == By::isotropic) {
        goes = -(isotropic + pad) * normal;
      } else {
        for (int j = 0; j < 3; ++j) moved.col(j) += angular.cross(Vec3(moved.col(j)));
        goes = linear - (secondOrder + pad) * normal;
        const Vec3 across = normal - angular * (angular.dot(normal) / angular.squaredNorm());
        if (across.norm() > 1e-6) goes -= secondOrderAcross * angular.norm() * across.normalized();
      }
      // The lowest point of the moved b and the highest point of a. Each is a corner, or an
      // arbitrary point of an edge or face that is parallel to the separating plane.
      const auto corner = [&](const Mat3& axes, const Vec3& towards) {
        Vec3 p = Vec3::Zero();
        for (int j = 0; j < 3; ++j) {
          const double height = towards.dot(axes.col(j));
          const bool level = std::abs(height) < 1e-9 * axes.col(j).norm();
          p += (level ? real(random) : sign(height)) * axes.col(j);
        }
        return p;
      };
      const Vec3 high = corner(A * ea.asDiagonal(), normal), low = corner(moved, -normal);
      const double sizes = ea.sum() + scale * eb.sum();
      // Places a's box in the middle, and b's box so that the two points meet.
      const Vec3 c = high - low - goes + gap * sizes * normal;
      const double length = std::max(1.0, c.norm());
      // Centres must be at most 3 apart, so the pair is shrunk by a power of two.
      const double less = std::ldexp(1.0, -std::ilogb(length) - 1) * std::min(1.0, scale);
      const Vec3 cb = M.transpose() * (less * c) / scale;
      for (int k = 0; k < 3; ++k) {
        b.vectors[k][Obb4::kCenter][i] = f(cb[k]);
        a.half[k][i] *= f(less), b.half[k][i] *= f(less);
        bound.linear[k][i] *= f(less);
      }
      bound.secondOrderAcross[i] *= f(less), bound.secondOrder[i] *= f(less);
      bound.pad[i] *= f(less), bound.isotropic[i] *= f(less);
    }
  }
};

class MovingBoxesKernel : public test::EveryTarget {};
INSTANTIATE_TEST_SUITE_P(Simd, MovingBoxesKernel, testing::ValuesIn(test::simdTargets()),
                         &test::targetName);

constexpr unsigned kDiagonal = 0x8421;

TEST_P(MovingBoxesKernel, BoxesThatMeetAreNotSeparated) {
  Random random(test::testSeed(61));
  for (int n = 0; n < 40'000 / test::kSlowdown; ++n) {
    const By by = n % 5 ? By::directions : By::isotropic;
    const Pairs pairs(random, n, by, -1e-7, n % 2);
    ASSERT_EQ(
        HWY_DYNAMIC_DISPATCH(openBoxes)(pairs.a, pairs.b, pairs.pose, pairs.bound) & kDiagonal,
        kDiagonal)
        << n;
  }
}

/// Nearly all pairs of boxes that stay apart must be separated. Here the motion bounds have only
/// first-order terms, or only the isotropic term. For such bounds the kernel's test is tight up to
/// rounding.
TEST_P(MovingBoxesKernel, BoxesThatStayApartAreSeparated) {
  Random random(test::testSeed(62));
  int asked = 0, open = 0;
  for (int n = 0; n < 40'000 / test::kSlowdown; ++n) {
    const By by = n % 5 ? By::directions : By::isotropic;
    const Pairs pairs(random, n, by, 0.1, false, -2);
    if (!pairs.steady) continue;
    ++asked;
    const unsigned found =
        HWY_DYNAMIC_DISPATCH(openBoxes)(pairs.a, pairs.b, pairs.pose, pairs.bound) & kDiagonal;
    open += found != 0;
  }
  std::cout << open << " of " << asked << "\n";
  EXPECT_LT(open, asked / 20);
}

}  // namespace
}  // namespace corridor
#endif
