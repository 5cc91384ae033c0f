#include <array>
#include <random>

#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "collision/queries/interference.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/support/brute_force.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::anyPose;
using test::kParams;
using test::soup;

template <class Volume>
class VolumeInterference : public testing::Test {};
TYPED_TEST_SUITE(VolumeInterference, test::Volumes, test::VolumeNames);

TYPED_TEST(VolumeInterference, SharedWorkloads) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  QueryContext context;
  std::array<std::size_t, std::size(kParams)> poseCount{};
  std::size_t turn = 0;
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    // On nearly parallel surfaces (the workloads whose names begin with "a"), looser volumes cost
    // thousands of times more. So fewer of their poses are tested.
    const std::size_t step = name[0] == 'a' ? 10 : 5;
    ++turn;
    for (std::size_t v = 0; v < std::size(kParams); ++v) {
      const auto poses = test::posesInTurn(w, step, v + turn, std::size(kParams));
      if (poses.empty()) continue;
      const VolumeTree<TypeParam> a(w.a, kParams[v]), b(w.b, kParams[v]);
      int wrong = 0;
      for (const std::size_t i : poses) {
        wrong +=
            interference(Posed(a), Posed(b, w.poses[i]), context).has_value() != (w.hit[i] == 1);
        wrong +=
            interference(Posed(b, w.poses[i]), Posed(a), context).has_value() != (w.hit[i] == 1);
      }
      EXPECT_EQ(wrong, 0) << name << ", " << test::str(kParams[v]);
      poseCount[v] += poses.size();
    }
  }
  for (const std::size_t count : poseCount) EXPECT_GT(count, 100 / test::kSlowdown);
  std::cout << "N_v " << context.counters.boxTests << ", N_p " << context.counters.primitiveTests
            << "\n";
}

/// Maps that are not quite rigid, near and far from the origin. The verdicts are compared with
/// brute force.
TYPED_TEST(VolumeInterference, AgreesWithBruteForceUnderTwoMaps) {
  std::mt19937_64 random(test::testSeed(5));
  int touching = 0, cases = 0;
  for (int n = 0; n < 160; ++n) {
    const TreeParams& params = kParams[n / 4 % std::size(kParams)];
    const TriangleMesh meshA = soup(random, 25, 0.2), meshB = soup(random, 25, 0.2);
    const VolumeTree<TypeParam> a(meshA, params), b(meshB, params);
    const double defect = n % 4 == 0 ? 0 : std::pow(10.0, -3 * (n % 4));
    const Vec3 common = (n % 3 == 0 ? 1e6 : 1) * Vec3(1, -2, 0.5);
    Transform X_WA = anyPose(random, 1), X_WB = anyPose(random, 1);
    for (Transform* X : {&X_WA, &X_WB}) {
      X->m += defect * anyPose(random, 1).m;
      X->t += common;
    }
    QueryContext context;
    const bool expected = test::bruteForceTouch(meshA, X_WA, meshB, X_WB);
    ASSERT_EQ(interference(Posed(a, X_WA), Posed(b, X_WB), context).has_value(), expected)
        << "case " << n;
    ASSERT_EQ(interference(Posed(b, X_WB), Posed(a, X_WA), context).has_value(), expected)
        << "case " << n;
    touching += expected;
    ++cases;
  }
  EXPECT_GT(touching, 10);
  EXPECT_LT(touching, cases - 10);
}

TYPED_TEST(VolumeInterference, ExtremeSizes) {
  std::mt19937_64 random(test::testSeed(3));
  for (const int exponent : {-1060, -500, -340, 330, 500, 1000}) {
    TriangleMesh meshA = soup(random, 12, 0.3), meshB = soup(random, 12, 0.3);
    for (TriangleMesh* m : {&meshA, &meshB})
      for (Vec3& v : m->vertices)
        v = v.unaryExpr([&](double x) { return std::ldexp(x, exponent); });
    const VolumeTree<TypeParam> a(meshA), b(meshB);
    QueryContext context;
    EXPECT_EQ(interference(Posed(a), Posed(b), context).has_value(),
              test::bruteForceTouch(meshA, {}, meshB, {}))
        << exponent;
  }
}

TYPED_TEST(VolumeInterference, ManyConvexParts) {
  std::mt19937_64 random(test::testSeed(9));
  int touching = 0;
  for (int n = 0; n < 40; ++n) {
    const TreeParams& params = kParams[n % std::size(kParams)];
    const auto partsA = test::parts(random, 12, 0.2);
    const VolumeTree<TypeParam> a(partsA, params), b(test::parts(random, 12, 0.2), params),
        mesh(soup(random, 12, 0.2), params);
    const Transform X_WA = anyPose(random, 0.3), X_WB = anyPose(random, 0.3);
    QueryContext context;
    bool parts = false, soupHit = false;
    for (const ConvexPart& s : a.parts()) {
      for (const ConvexPart& t : b.parts()) parts = parts || convexSetsTouch({s, X_WA}, {t, X_WB});
      for (const Triangle& t : mesh.triangles())
        soupHit = soupHit || convexSetsTouch({s, X_WA}, {t, X_WB});
    }
    const auto found = interference(Posed(a, X_WA), Posed(b, X_WB), context);
    EXPECT_EQ(found.has_value(), parts) << n;
    EXPECT_EQ(interference(Posed(mesh, X_WB), Posed(a, X_WA), context).has_value(), soupHit) << n;
    if (found) {  // the reported indices must be those of the list of parts
      bool same = false;
      for (std::size_t i = 0; i < a.parts().size(); ++i)
        same = same || (a.meshTriangle(static_cast<std::uint32_t>(i)) == found->a &&
                        a.parts()[i].points[0] == partsA[found->a].points[0]);
      EXPECT_TRUE(same);
    }
    touching += parts + soupHit;
  }
  EXPECT_GT(touching, 10);
  EXPECT_LT(touching, 70);
}

}  // namespace
}  // namespace corridor
