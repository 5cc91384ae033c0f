// Tests the kernel that bounds distances of boxes (overlap_obb4_obb4-inl.h) against distances of
// their surfaces, in double.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/core/transform.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/collision/volumes/near_boxes_test.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/volumes/overlap_obb4_obb4-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

unsigned far(const Obb4& a, const Obb4& b, const Obb4Pose& pose, float limit, float* squares) {
  return nearBoxes<true>(a, b, pose, limit, squares);
}
unsigned near(const Obb4& a, const Obb4& b, const Obb4Pose& pose, float limit, float* squares) {
  return nearBoxes<false>(a, b, pose, limit, squares);
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "collision/hierarchy/obb_tree.h"
#include "collision/queries/distance.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

HWY_EXPORT(far);
HWY_EXPORT(near);

class NearBoxes : public test::EveryTarget {
 protected:
  double real(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }

  /// Returns four boxes of very different sizes, around the frame's origin. If `upright`, their
  /// axes are parallel to those of the frame, and their centres are on the z axis.
  Obb4 boxes(bool upright) {
    Obb4 four = {};
    for (int l = 0; l < 4; ++l) {
      Transform X = test::anyPose(random_, 0.3);
      if (upright) X = {Mat3::Identity(), X.t[2] * Vec3::UnitZ()};
      const double size = std::pow(10.0, real(-3, -0.3));
      for (int k = 0; k < 3; ++k) {
        four.half[k][l] = static_cast<float>(size * real(k ? 0 : 0.5, 1));
        four.vectors[k][Obb4::kCenter][l] = static_cast<float>(X.t[k]);
        for (int j = 0; j < 3; ++j) four.vectors[k][j][l] = static_cast<float>(X.m(k, j));
      }
    }
    return four;
  }
  static TriangleMesh meshOf(const Obb4& four, int lane) {
    TriangleMesh mesh = test::box(Vec3(-1, -1, -1), Vec3(1, 1, 1));
    for (Vec3& v : mesh.vertices) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) {
        p[k] = four.vectors[k][Obb4::kCenter][lane];
        for (int j = 0; j < 3; ++j) p[k] += v[j] * four.half[j][lane] * four.vectors[k][j][lane];
      }
      v = p;
    }
    return mesh;
  }
  static double radius(const Obb4& four, int lane) {
    return std::hypot(four.half[0][lane], four.half[1][lane], four.half[2][lane]);
  }

  std::mt19937_64 random_{test::testSeed(52)};
};

INSTANTIATE_TEST_SUITE_P(Targets, NearBoxes, testing::ValuesIn(test::simdTargets()),
                         test::targetName);

/// The bound must never be above the distance d, and no pair within the limit may be reported as
/// separated. The bound must also not be below the gap along the line between the centres. Consider
/// the two extreme points of the boxes along that line. They differ by this gap along the line, and
/// by at most the sum r of both radii across the line. So gap² ≥ d² − r².
TEST_P(NearBoxes, BoundTheirDistances) {
  QueryContext context;
  int apart = 0, within = 0;
  for (int n = 0; n < 300; ++n) {
    // For upright boxes above each other, the gap along the line between the centres is the exact
    // distance. Therefore any rounding that the margin does not cover makes the test fail.
    const bool upright = n % 3 == 0;
    const Obb4 a = boxes(upright), b = boxes(upright);
    Transform X = test::anyPose(random_, std::pow(10.0, real(-1, 1.5)));
    // Some poses are so far away, and some boxes of b so large, that squares of squared lengths
    // overflow.
    const double unit = n % 3 == 1 && n % 5 == 0 ? 0x1p45 : 1;
    const double scale = unit * std::ldexp(1.0, n % 7 - 3);
    X.t *= unit;
    if (upright) {  // the first two boxes are a little apart
      const auto middle = [](const Obb4& four) { return four.vectors[2][Obb4::kCenter][0]; };
      const double gap = std::pow(10.0, real(-8, 1));
      X = {Mat3::Identity(),
           (middle(a) - scale * middle(b) + a.half[2][0] + scale * b.half[2][0] + gap) *
               Vec3::UnitZ()};
    }
    Obb4Pose pose = {};
    Transform exact;  // the map that the floats define
    for (int k = 0; k < 3; ++k) {
      pose.offset[k] = static_cast<float>(X.t[k]);
      exact.t[k] = pose.offset[k];
      for (int j = 0; j < 3; ++j) {
        pose.turn[j][k] = static_cast<float>(X.m(k, j));
        exact.m(k, j) = scale * pose.turn[j][k];
      }
    }
    pose.scale = static_cast<float>(scale);
    // Margins as in `Obb4TreePose`, for a map that is off from a rotation by the rounding of its
    // floats.
    constexpr double u = 0x1p-24;
    pose.relative = static_cast<float>(180 * u + 20 * u);
    pose.absoluteMargin =
        static_cast<float>(u * (33 * scale + 3.1 * exact.t.cwiseAbs().sum() + 6) * 1.01);
    alignas(64) float squares[16];
    const double limit = unit * std::pow(10.0, real(-1, 1.5));
    const unsigned open = HWY_DYNAMIC_DISPATCH(far)(a, b, pose, static_cast<float>(limit), squares);
    alignas(64) float fewer[16];
    const unsigned openByFewer =
        HWY_DYNAMIC_DISPATCH(near)(a, b, pose, static_cast<float>(limit), fewer);
    EXPECT_EQ(open & ~openByFewer, 0u) << n;
    for (int i = 0; i < 16; ++i) EXPECT_LE(fewer[i], squares[i]) << n;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const double d =
            distance(Posed(ObbTree(meshOf(a, i))), Posed(ObbTree(meshOf(b, j)), exact), {}, context)
                .distance;
        const double least = std::sqrt(squares[4 * i + j]);
        const double r = radius(a, i) + scale * radius(b, j), size = d + r;
        ASSERT_LE(least, d * (1 + 1e-9)) << n;
        if (d * (1 + 1e-9) <= static_cast<float>(limit)) {
          ASSERT_TRUE(open >> (4 * i + j) & 1) << n << ": " << d << ", " << limit;
          ++within;
        }
        // The bound is too small by at most 2^-14 of its value and the margins of the pose.
        const double margin =
            4 * (static_cast<double>(pose.relative) * 3 * size + pose.absoluteMargin);
        if (d > r) {
          ASSERT_GE(least, std::sqrt(d * d - r * r) * (1 - 0x1p-14) - margin) << n << ": " << d;
        }
        apart += !(open >> (4 * i + j) & 1);
      }
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(within, 500);
}

}  // namespace
}  // namespace corridor
#endif
