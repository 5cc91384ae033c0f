#include <cmath>
#include <hwy/highway.h>
#include <random>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <gtest/gtest.h>

#include "collision/predicates/triangle_contact.h"
#include "collision/queries/interference_wide.h"
#include "tests/collision/hierarchy/soups.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::anyPose;
using test::soup;

/// Every SIMD target of this machine in turn; the best again at the end.
class EveryTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

std::vector<std::int64_t> targets() {
  std::vector<std::int64_t> all;
  for (std::int64_t rest = hwy::SupportedTargets() & HWY_TARGETS & ~(HWY_SCALAR | HWY_EMU128); rest;
       rest &= rest - 1)
    all.push_back(rest & -rest);
  return all;
}

bool bruteForce(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                const Transform& X_WB) {
  Counters counters;
  for (std::size_t s = 0; s < a.triangles.size(); ++s)
    for (std::size_t t = 0; t < b.triangles.size(); ++t)
      if (trianglesTouch({a.corner(s, 0), a.corner(s, 1), a.corner(s, 2)}, X_WA,
                         {b.corner(t, 0), b.corner(t, 1), b.corner(t, 2)}, X_WB, counters))
        return true;
  return false;
}

TEST_P(EveryTarget, SharedWorkloads) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  QueryContext context;
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    const WideObbTree a(w.a), b(w.b);
    int wrong = 0;
    for (std::size_t i = 0; i < w.poses.size(); i += test::kSlowdown) {
      wrong += interference(a, {}, b, w.poses[i], context).has_value() != (w.hit[i] == 1);
      wrong += interference(b, w.poses[i], a, {}, context).has_value() != (w.hit[i] == 1);
    }
    EXPECT_EQ(wrong, 0) << name;
  }
}

/// Every map that is not quite rigid, far away and near, against the double loop.
TEST_P(EveryTarget, AgreesWithBruteForceUnderTwoMaps) {
  std::mt19937_64 random(test::testSeed(5));
  int touching = 0, cases = 0;
  for (int n = 0; n < 400; ++n) {
    const int count = 1 + static_cast<int>(random() % 40);
    const TriangleMesh meshA = soup(random, count, 0.2),
                       meshB = soup(random, 41 - count, n % 5 ? 0.2 : 0.01);
    const WideObbTree a(meshA), b(meshB);
    const double defect = n % 4 == 0 ? 0 : std::pow(10.0, -3 * (n % 4));
    const Vec3 common = (n % 3 == 0 ? 1e6 : 1) * Vec3(1, -2, 0.5);
    Transform X_WA = anyPose(random, 0.6), X_WB = anyPose(random, 0.6);
    for (Transform* X : {&X_WA, &X_WB}) {
      X->m += defect * anyPose(random, 1).m;
      X->t += common;
    }
    QueryContext context;
    const bool expected = bruteForce(meshA, X_WA, meshB, X_WB);
    const auto found = interference(a, X_WA, b, X_WB, context);
    ASSERT_EQ(found.has_value(), expected) << "case " << n;
    ASSERT_EQ(interference(b, X_WB, a, X_WA, context).has_value(), expected) << "case " << n;
    if (found) {
      const auto corner = [](const TriangleMesh& m, std::uint32_t t) {
        return Triangle{m.corner(t, 0), m.corner(t, 1), m.corner(t, 2)};
      };
      EXPECT_TRUE(
          trianglesTouchExact(corner(meshA, found->a), X_WA, corner(meshB, found->b), X_WB));
    }
    touching += expected;
    ++cases;
  }
  EXPECT_GT(touching, 50);
  EXPECT_LT(touching, cases - 50);
}

/// Two meshes of sizes 2^i and 2^k, touching in one point, or apart by 2^-20 of the smaller.
TEST_P(EveryTarget, ExtremeSizesAndRatios) {
  std::mt19937_64 random(test::testSeed(3));
  for (const int i : {-1020, -500, -100, -30, 0, 30, 100, 500, 950})
    for (const int k : {-1020, -500, -100, -30, 0, 30, 100, 500, 950}) {
      TriangleMesh a = soup(random, 10, 0.3), b = soup(random, 10, 0.3);
      for (auto [mesh, exponent] : {std::pair(&a, i), std::pair(&b, k)})
        for (Vec3& v : mesh->vertices)
          v = v.unaryExpr([e = exponent](double x) { return std::ldexp(x, e); });
      const WideObbTree treeA(a), treeB(b);
      QueryContext context;
      Transform X;
      EXPECT_EQ(interference(treeA, {}, treeB, X, context).has_value(), bruteForce(a, {}, b, X))
          << i << " " << k;
      X.t = a.vertices[4] - b.vertices[7];
      EXPECT_EQ(interference(treeA, {}, treeB, X, context).has_value(), bruteForce(a, {}, b, X))
          << i << " " << k;
    }
}

/// Leaves of triangles far smaller than their distances, one pair of which touches in a corner of
/// the grid: the leaf's floats are those of the leaf, not of the triangle.
TEST_P(EveryTarget, SmallTrianglesFarApart) {
  std::mt19937_64 random(test::testSeed(17));
  const auto grid = [&](double size) {  // multiples of 2^-34
    return std::round(std::uniform_real_distribution(-size, size)(random) * 0x1p34) * 0x1p-34;
  };
  const auto any = [&](double size) {
    const double x = grid(size), y = grid(size), z = grid(size);
    return Vec3(x, y, z);
  };
  int touching = 0;
  for (int n = 0; n < 4'000 / test::kSlowdown; ++n) {
    const double size = std::ldexp(1.0, -static_cast<int>(random() % 19));
    TriangleMesh a, b;
    const Vec3 p = any(1);
    for (TriangleMesh* mesh : {&a, &b})
      for (int i = 0; i < 1 + static_cast<int>(random() % 6); ++i) {
        const Vec3 q = i == 0 ? p : any(1);
        test::add(*mesh, q, q + any(size), q + any(size));
      }
    // A quarter turn and a shift that doubles hold.
    Transform X;
    X.m << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    X.t = any(4);
    for (Vec3& v : b.vertices) v = X.m.transpose() * (v - X.t);
    const WideObbTree treeA(a), treeB(b);
    QueryContext context;
    const bool expected = bruteForce(a, {}, b, X);
    ASSERT_EQ(interference(treeA, {}, treeB, X, context).has_value(), expected) << n;
    ASSERT_EQ(interference(treeB, X, treeA, {}, context).has_value(), expected) << n;
    touching += expected;
  }
  EXPECT_GT(touching, 3'000 / test::kSlowdown);
}

#ifdef __SSE2__
/// A library that is linked may set the processor to flush what underflows to zero.
TEST_P(EveryTarget, FlushToZero) {
  const unsigned before = _mm_getcsr();
  std::mt19937_64 random(test::testSeed(18));
  for (int n = 0; n < 1'000 / test::kSlowdown; ++n) {
    TriangleMesh a = soup(random, 6, 0.3), b = soup(random, 6, 0.3);
    const int exponent = n % 3 == 0 ? -996 : n % 3 == 1 ? -512 : -30;
    for (TriangleMesh* mesh : {&a, &b})
      for (Vec3& v : mesh->vertices)
        v = v.unaryExpr(
            [&](double x) { return std::ldexp(std::round(x * 0x1p20), exponent - 20); });
    const Vec3 shift = a.vertices[n % a.vertices.size()] - b.vertices[0];  // they share a corner
    for (Vec3& v : b.vertices) v += shift;
    _mm_setcsr(before | 0x8040);  // flush to zero, denormals are zero
    const WideObbTree treeA(a), treeB(b);
    QueryContext context;
    const bool found = interference(treeA, {}, treeB, {}, context).has_value();
    _mm_setcsr(before);
    ASSERT_TRUE(found) << n;
  }
}
#endif

/// Boxes on a grid that touch exactly, under quarter turns, or miss by one part in 2^40.
TEST_P(EveryTarget, ExactTouch) {
  const auto boxMesh = [](const Vec3& low, const Vec3& high) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
      mesh.vertices.emplace_back(i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1],
                                 i & 4 ? high[2] : low[2]);
    for (const auto& t : {std::array<std::uint32_t, 3>{0, 1, 3},
                          {0, 3, 2},
                          {4, 5, 7},
                          {4, 7, 6},
                          {0, 1, 5},
                          {0, 5, 4},
                          {2, 3, 7},
                          {2, 7, 6},
                          {0, 2, 6},
                          {0, 6, 4},
                          {1, 3, 7},
                          {1, 7, 5}})
      mesh.triangles.push_back(t);
    return mesh;
  };
  const WideObbTree a(boxMesh(Vec3(0, 0, 0), Vec3(1, 2, 3))),
      b(boxMesh(Vec3(-1, -1, -1), Vec3(0, 1, 2)));
  QueryContext context;
  Transform turn;  // x → y → z → x
  turn.m << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  // Turned, b is [−1, 2] × [−1, 0] × [−1, 1].
  for (const auto& [t, touches] : {std::pair(Vec3(0, 0, 0), true),
                                   {Vec3(-2, 0, 0), true},
                                   {Vec3(2, 0, 0), true},
                                   {Vec3(2, 3, 4), true},
                                   {Vec3(-2, 3, -1), true},
                                   {Vec3(2 + 0x1p-40, 0, 0), false},
                                   {Vec3(2, 3, 4 + 0x1p-40), false},
                                   {Vec3(0, -0x1p-40, 0), false}}) {
    turn.t = t;
    EXPECT_EQ(interference(a, {}, b, turn, context).has_value(), touches) << t.transpose();
    EXPECT_EQ(interference(b, turn, a, {}, context).has_value(), touches) << t.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(Simd, EveryTarget, testing::ValuesIn(targets()),
                         [](const auto& p) { return std::string(hwy::TargetName(p.param)); });

/// Kernels of all targets round alike: the same boxes are tested, whatever the machine.
TEST(WideInterference, TargetsCountAlike) {
  std::mt19937_64 random(test::testSeed(8));
  for (int n = 0; n < 50; ++n) {
    const TriangleMesh meshA = soup(random, 200, 0.1), meshB = soup(random, 200, 0.1);
    const WideObbTree a(meshA), b(meshB);
    const Transform X = anyPose(random, 0.8);
    std::optional<Counters> first;
    for (const std::int64_t target : targets()) {
      hwy::SetSupportedTargetsForTest(target);
      QueryContext context;
      (void)interference(a, {}, b, X, context);
      if (!first) first = context.counters;
      EXPECT_EQ(context.counters.boxTests, first->boxTests) << hwy::TargetName(target);
      EXPECT_EQ(context.counters.triangleTests, first->triangleTests) << hwy::TargetName(target);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// A context's stack grows once; no answer depends on what it held.
TEST(WideInterference, ContextsAreReused) {
  std::mt19937_64 random(test::testSeed(13));
  QueryContext used;
  for (int n = 0; n < 100; ++n) {
    const WideObbTree a(soup(random, 50, 0.2)), b(soup(random, 50, 0.2));
    const Transform X = anyPose(random, 0.8);
    QueryContext fresh;
    EXPECT_EQ(interference(a, {}, b, X, used).has_value(),
              interference(a, {}, b, X, fresh).has_value());
  }
}

}  // namespace
}  // namespace corridor
