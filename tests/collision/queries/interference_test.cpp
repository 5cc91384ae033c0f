#include "collision/queries/interference.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/predicates/triangle_contact.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/tree_fault.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::corners;
using test::soup;

class Fits : public testing::TestWithParam<ObbFit> {};

TEST_P(Fits, SharedWorkloads) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  QueryContext context;
  int poses = 0;
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    // Building trees by hulls would take 20 times longer than the queries at these few poses.
    const bool longBuild = w.poses.size() < 100 && w.a.triangles.size() > 2'000;
    if (GetParam() == ObbFit::hull && longBuild && !test::isStressRun()) continue;
    const ObbTree a(w.a, {GetParam()}), b(w.b, {GetParam()});
    int wrong = 0;
    for (std::size_t i = 0; i < w.poses.size(); i += test::kSlowdown) {
      wrong += interference(Posed(a), Posed(b, w.poses[i]), context).has_value() != (w.hit[i] == 1);
      wrong += interference(Posed(b, w.poses[i]), Posed(a), context).has_value() != (w.hit[i] == 1);
    }
    EXPECT_EQ(wrong, 0) << name;
    poses += static_cast<int>(w.poses.size());
  }
  EXPECT_GT(poses, 5'000);
  std::cout << "1 in " << test::kSlowdown << " of " << poses << " poses, N_v "
            << context.counters.boxTests << ", N_p " << context.counters.primitiveTests
            << ", exact " << context.counters.exactTests << "\n";
}

/// Maps are not quite rigid, and the relative pose is rounded. The verdicts are compared with brute
/// force by exact triangle tests.
TEST_P(Fits, AgreesWithBruteForceUnderTwoMaps) {
  std::mt19937_64 random(test::testSeed(5));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  int touching = 0, cases = 0;
  for (int n = 0; n < 200; ++n) {
    const TriangleMesh meshA = soup(random, 25, 0.2), meshB = soup(random, 25, 0.2);
    const ObbTree a(meshA, {GetParam()}), b(meshB, {GetParam()});
    const double defect =
        // The maps differ from rotations by up to 1e-3.
        n % 4 == 0 ? 0 : std::pow(10.0, -3 * (n % 4));
    const double offset = n % 3 == 0 ? 1e6 : 1;
    Transform X_WA, X_WB;
    const Vec3 common = offset * Vec3(real(), real(), real());
    for (Transform* X : {&X_WA, &X_WB}) {
      X->m = Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix() +
             defect * Mat3::Random();
      X->t = common + 2 * Vec3(real(), real(), real());
    }
    QueryContext context;
    const bool expected = test::bruteForceTouch(meshA, X_WA, meshB, X_WB);
    const auto found = interference(Posed(a, X_WA), Posed(b, X_WB), context);
    ASSERT_EQ(found.has_value(), expected) << "case " << n;
    if (found) {
      EXPECT_TRUE(
          trianglesTouchExact(corners(meshA, found->a), X_WA, corners(meshB, found->b), X_WB));
    }
    touching += expected;
    ++cases;
  }
  EXPECT_GT(touching, 10);
  EXPECT_LT(touching, cases - 10);
}

/// Both bodies have one corner exactly in common, under equal maps that are only nearly rigid. A
/// tree that pruned by the rounded relative pose without a margin would lose this contact.
TEST_P(Fits, ExactMapDecidesDeepInATree) {
  std::mt19937_64 random(test::testSeed(11));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  TriangleMesh mesh = soup(random, 2'000, 0.01);
  for (Vec3& v : mesh.vertices) v[2] -= 2;  // all below z = 0
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(),
                       {Vec3(0.3, 0.2, 0), Vec3(0.4, 0.2, -0.1), Vec3(0.3, 0.3, -0.1)});
  mesh.triangles.push_back({n, n + 1, n + 2});
  const ObbTree a(mesh, {GetParam()});
  for (int k = 0; k < 200; ++k) {
    const double stretch = 1 + 0x1p-30 * (1 + k % 8);
    TriangleMesh tip;
    tip.vertices = {Vec3(0.3, 0.2, 0), Vec3(0.3 + 0.1, 0.2, 0.1), Vec3(0.3, 0.2 + 0.1, 0.1)};
    tip.triangles = {{0, 1, 2}};
    Transform X_WA{
        Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix() *
            stretch,
        Vec3(real(), real(), real()) * 1e3};
    const ObbTree b(tip, {GetParam()});
    QueryContext context;
    EXPECT_TRUE(interference(Posed(a, X_WA), Posed(b, X_WA), context))
        << k;  // the maps are equal, so the images of the shared corner are, too
    Transform X_WB = X_WA;
    X_WB.t[0] += k % 2 ? 1e-3 : 0;
    EXPECT_EQ(interference(Posed(a, X_WA), Posed(b, X_WB), context).has_value(),
              test::bruteForceTouch(mesh, X_WA, tip, X_WB));
  }
}

TEST_P(Fits, ExtremeSizes) {
  std::mt19937_64 random(test::testSeed(3));
  for (const int exponent : {-1060, -500, -340, 330, 500, 1000}) {
    TriangleMesh meshA = soup(random, 20, 0.3), meshB = soup(random, 20, 0.3);
    for (TriangleMesh* m : {&meshA, &meshB})
      for (Vec3& v : m->vertices)
        v = v.unaryExpr([&](double x) { return std::ldexp(x, exponent); });
    const ObbTree a(meshA, {GetParam()}), b(meshB, {GetParam()});
    EXPECT_EQ(test::treeFault(a), std::nullopt) << exponent;
    QueryContext context;
    EXPECT_EQ(interference(Posed(a), Posed(b), context).has_value(),
              test::bruteForceTouch(meshA, {}, meshB, {}))
        << exponent;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Fits,
                         testing::Values(ObbFit::vertices, ObbFit::triangles, ObbFit::hull),
                         [](const auto& p) {
                           return p.param == ObbFit::vertices    ? "vertices"
                                  : p.param == ObbFit::triangles ? "triangles"
                                                                 : "hull";
                         });

}  // namespace
}  // namespace corridor
