#include <cmath>
#include <hwy/highway.h>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "collision/predicates/triangle_contact.h"
#include "collision/queries/interference_obb4.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::anyPose;
using test::bruteForceTouch;
using test::corners;
using test::soup;

class Obb4Interference : public test::EveryTarget {};

TEST_P(Obb4Interference, SharedWorkloads) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  QueryContext context;
  std::size_t turn = 0;
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    ++turn;
    for (std::size_t f = 0; f < std::size(test::kFits); ++f) {
      const auto& [fit, fitName] = test::kFits[f];
      const auto poses = test::posesOfFit(w, 1, f, turn);
      if (poses.empty()) continue;
      const Obb4Tree a(w.a, fit), b(w.b, fit);
      int wrong = 0;
      for (const std::size_t i : poses) {
        wrong +=
            interference(Posed(a), Posed(b, w.poses[i]), context).has_value() != (w.hit[i] == 1);
        wrong +=
            interference(Posed(b, w.poses[i]), Posed(a), context).has_value() != (w.hit[i] == 1);
      }
      EXPECT_EQ(wrong, 0) << name << ", " << fitName;
    }
  }
}

/// Maps that are not quite rigid, near and far from the origin. The verdicts are compared with
/// brute force.
TEST_P(Obb4Interference, AgreesWithBruteForceUnderTwoMaps) {
  std::mt19937_64 random(test::testSeed(5));
  int touching = 0, cases = 0;
  for (int n = 0; n < 400; ++n) {
    const int count = 1 + static_cast<int>(random() % 40);
    const TriangleMesh meshA = soup(random, count, 0.2),
                       meshB = soup(random, 41 - count, n % 5 ? 0.2 : 0.01);
    const Obb4Tree a(meshA), b(meshB);
    const double defect = n % 4 == 0 ? 0 : std::pow(10.0, -3 * (n % 4));
    const Vec3 common = (n % 3 == 0 ? 1e6 : 1) * Vec3(1, -2, 0.5);
    Transform X_WA = anyPose(random, 0.6), X_WB = anyPose(random, 0.6);
    for (Transform* X : {&X_WA, &X_WB}) {
      X->m += defect * anyPose(random, 1).m;
      X->t += common;
    }
    QueryContext context;
    const bool expected = bruteForceTouch(meshA, X_WA, meshB, X_WB);
    const auto found = interference(Posed(a, X_WA), Posed(b, X_WB), context);
    ASSERT_EQ(found.has_value(), expected) << "case " << n;
    ASSERT_EQ(interference(Posed(b, X_WB), Posed(a, X_WA), context).has_value(), expected)
        << "case " << n;
    if (found) {
      EXPECT_TRUE(
          trianglesTouchExact(corners(meshA, found->a), X_WA, corners(meshB, found->b), X_WB));
    }
    touching += expected;
    ++cases;
  }
  EXPECT_GT(touching, 50);
  EXPECT_LT(touching, cases - 50);
}

/// Two meshes of sizes 2^i and 2^k. First both are around one point; then a vertex of one mesh and
/// a vertex of the other are at the same point, up to rounding.
TEST_P(Obb4Interference, ExtremeSizesAndRatios) {
  std::mt19937_64 random(test::testSeed(3));
  for (const int i : {-1020, -500, -100, -30, 0, 30, 100, 500, 950})
    for (const int k : {-1020, -500, -100, -30, 0, 30, 100, 500, 950}) {
      TriangleMesh a = soup(random, 10, 0.3), b = soup(random, 10, 0.3);
      for (auto [mesh, exponent] : {std::pair(&a, i), std::pair(&b, k)})
        for (Vec3& v : mesh->vertices)
          v = v.unaryExpr([e = exponent](double x) { return std::ldexp(x, e); });
      const Obb4Tree treeA(a), treeB(b);
      QueryContext context;
      Transform X;
      EXPECT_EQ(interference(Posed(treeA), Posed(treeB, X), context).has_value(),
                bruteForceTouch(a, {}, b, X))
          << i << " " << k;
      X.t = a.vertices[4] - b.vertices[7];
      EXPECT_EQ(interference(Posed(treeA), Posed(treeB, X), context).has_value(),
                bruteForceTouch(a, {}, b, X))
          << i << " " << k;
    }
}

/// Boxes on a grid, which touch exactly or miss each other by 2^-40. One box is rotated by a
/// permutation of the axes.
TEST_P(Obb4Interference, ExactTouch) {
  const Obb4Tree a(test::box(Vec3(0, 0, 0), Vec3(1, 2, 3))),
      b(test::box(Vec3(-1, -1, -1), Vec3(0, 1, 2)));
  QueryContext context;
  Transform turn;  // x → y → z → x
  turn.m << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  // Rotated, b is [−1, 2] × [−1, 0] × [−1, 1].
  for (const auto& [t, touches] : {std::pair(Vec3(0, 0, 0), true),
                                   {Vec3(-2, 0, 0), true},
                                   {Vec3(2, 0, 0), true},
                                   {Vec3(2, 3, 4), true},
                                   {Vec3(-2, 3, -1), true},
                                   {Vec3(2 + 0x1p-40, 0, 0), false},
                                   {Vec3(2, 3, 4 + 0x1p-40), false},
                                   {Vec3(0, -0x1p-40, 0), false}}) {
    turn.t = t;
    EXPECT_EQ(interference(Posed(a), Posed(b, turn), context).has_value(), touches)
        << t.transpose();
    EXPECT_EQ(interference(Posed(b, turn), Posed(a), context).has_value(), touches)
        << t.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Simd, Obb4Interference, testing::ValuesIn(test::simdTargets()),
                         &test::targetName);

/// All SIMD targets with fused multiply-add round alike, and so do all targets without it.
/// Therefore, within each of the two groups, queries test the same boxes and triangles.
TEST(Obb4InterferenceOf, TargetsCountAlike) {
  std::mt19937_64 random(test::testSeed(8));
  for (int n = 0; n < 50; ++n) {
    const TriangleMesh meshA = soup(random, 200, 0.1), meshB = soup(random, 200, 0.1);
    const Obb4Tree a(meshA), b(meshB);
    const Transform X = anyPose(random, 0.8);
    std::map<bool, Counters> first;
    for (const std::int64_t target : test::simdTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      QueryContext context;
      (void)interference(Posed(a), Posed(b, X), context);
      const bool fused = !(target & (HWY_SSSE3 | HWY_SSE4));
      const Counters& same = first.try_emplace(fused, context.counters).first->second;
      EXPECT_EQ(context.counters.boxTests, same.boxTests) << hwy::TargetName(target);
      EXPECT_EQ(context.counters.primitiveTests, same.primitiveTests) << hwy::TargetName(target);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// No verdict may depend on the earlier queries of a context.
TEST(Obb4InterferenceOf, ContextsAreReused) {
  std::mt19937_64 random(test::testSeed(13));
  QueryContext used;
  for (int n = 0; n < 100; ++n) {
    const Obb4Tree a(soup(random, 50, 0.2)), b(soup(random, 50, 0.2));
    const Transform X = anyPose(random, 0.8);
    QueryContext fresh;
    EXPECT_EQ(interference(Posed(a), Posed(b, X), used).has_value(),
              interference(Posed(a), Posed(b, X), fresh).has_value());
  }
}

}  // namespace
}  // namespace corridor
