#include "collision/queries/distance.h"

#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closer_triangles.h"
#include "collision/queries/closest_points.h"
#include "collision/queries/interference.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/collision/queries/true_distances.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/reference_distance.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::anyPose;
using test::corners;
using test::errorScale;
using test::kParams;
using test::soup;

/// Distances of random triangles, slivers and nearly parallel edges, at all scales.
TEST(ClosestPoints, WithinTheirErrorOfTheExactDistance) {
  std::mt19937_64 random(test::testSeed(21));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  const auto any = [&] { return Vec3(real(), real(), real()); };
  double worst = 0, tightest = 0;
  for (int n = 0; n < 6'000; ++n) {
    const double scale = std::ldexp(1.0, n % 9 == 0 ? -330 : n % 9 == 1 ? 330 : 0);
    const double flat = std::pow(10.0, -n % 37), offset = n % 4 == 0 ? 1e5 : 1;
    const Vec3 c = offset * any();
    Triangle a = {any(), any(), any()}, b = {any(), any(), any()};
    if (n % 2) b = {a[0] + flat * any(), a[1] + flat * any(), any()};  // nearly parallel edges
    if (n % 5 == 0) a[2] = a[1] + flat * any();
    for (Vec3& p : a) p = scale * (p + c);
    for (Vec3& p : b) p = scale * (p + c + Vec3(0, 0, std::pow(10.0, -n % 7)));
    Transform X_WA = anyPose(random, scale), X_WB = X_WA;
    if (n % 3 == 0) X_WB = anyPose(random, scale);
    Counters counters;
    if (trianglesTouch(a, X_WA, b, X_WB)) continue;
    const double truth = test::referenceDistance(a, X_WA, b, X_WB);
    const double size = std::max(errorScale(a, X_WA), errorScale(b, X_WB));
    const WitnessPoints w = witnessPoints(a, X_WA, b, X_WB);
    worst = std::max(worst, std::abs(w.distance - truth) / w.error);
    EXPECT_LE(w.error, kUnit * (size / 4 + 2 * truth) * (1 + 1e-10)) << n;
    for (const auto& [p, t, X] : {std::tuple(w.p_WA, a, X_WA), std::tuple(w.p_WB, b, X_WB)})
      EXPECT_LE(test::referenceDistance(p, t, X), 4 * kUnit * size) << n;
    double reachA = 0, reachB = 0;
    for (int i = 0; i < 3; ++i) {
      reachA = std::max(reachA, a[i].norm() * (1 + 1e-15));
      reachB = std::max(reachB, b[i].norm() * (1 + 1e-15));
    }
    const DistanceRange range = TriangleDistances(X_WA, reachA, X_WB, reachB)(a, b);
    EXPECT_LE(range.lower, truth) << n;
    EXPECT_GE(range.upper, truth) << n;
    // The tolerance query must be true for the next double above the true distance.
    EXPECT_TRUE(CloserTriangles(X_WA, reachA, X_WB, reachB, std::nextafter(truth, HUGE_VAL))(
        a, b, counters))
        << n;
    tightest += range.upper - range.lower < 1e-3 * truth;
  }
  EXPECT_LE(worst, 1);
  EXPECT_GT(tightest, 1'000);
  std::cout << "worst error, as a share of the allowed error: " << worst << "\n";
}

/// Two triangles in one plane. One of them is nearly a segment: one corner is only 2^-1074 off the
/// line through the others. With a hundred digits, the two long sides of this triangle cannot be
/// distinguished: an oracle with a hundred digits returned a distance of 0.
TEST(ClosestPoints, TriangleOneSubnormalWide) {
  const Triangle a = {Vec3(-6, -5, 14), Vec3(-4, -4, std::nextafter(13.0, 0.0)),
                      Vec3(std::nextafter(2.0, 0.0), 2, 1)},
                 b = {Vec3(0, 1, 2), Vec3(-0x1p-1074, 1, 2), Vec3(-4, -3, 10)};
  const double truth = std::sqrt(22.0 / 141);  // between b's last corner and a's edge 2-0
  EXPECT_NEAR(test::referenceDistance(a, {}, b, {}), truth, 32 * kUnit);
  EXPECT_NEAR(witnessPoints(a, {}, b, {}).distance, truth, 32 * kUnit);
}

template <class Volume>
class VolumeDistance : public testing::Test {};
TYPED_TEST_SUITE(VolumeDistance, test::Volumes, test::VolumeNames);

TYPED_TEST(VolumeDistance, SharedWorkloads) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  QueryContext context;
  std::size_t turn = 0;
  int checked[std::size(kParams)] = {};
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    if (!w.hasDistances()) continue;
    ++turn;
    for (std::size_t v = 0; v < std::size(kParams); ++v) {
      const std::size_t step = name[0] == 'a' ? 10 : 40;
      const auto poses = test::posesInTurn(w, step, v + turn, std::size(kParams));
      if (poses.empty()) continue;
      const VolumeTree<TypeParam> a(w.a, kParams[v]), b(w.b, kParams[v]);
      checked[v] += test::expectTrueDistances(w, a, b, poses, test::str(kParams[v]), context);
    }
  }
  for (const int count : checked) EXPECT_GT(count, 40 / test::kSlowdown);
  std::cout << "N_v " << context.counters.boxTests << ", N_p " << context.counters.primitiveTests
            << "\n";
}

TYPED_TEST(VolumeDistance, AgreesWithBruteForceAndIsSymmetric) {
  std::mt19937_64 random(test::testSeed(22));
  for (int n = 0; n < 40; ++n) {
    const TreeParams& params = kParams[n % std::size(kParams)];
    const TriangleMesh meshA = soup(random, 15, 0.1), meshB = soup(random, 15, 0.1);
    const VolumeTree<TypeParam> a(meshA, params), b(meshB, params);
    Transform X_WA = anyPose(random, n % 3 ? 1 : 1e4), X_WB = X_WA;
    X_WB.t += anyPose(random, 1.5).t;
    if (n % 2) X_WB.m = anyPose(random, 1).m;
    QueryContext context;
    const bool touch = interference(Posed(a, X_WA), Posed(b, X_WB), context).has_value();
    const Distance d = distance(Posed(a, X_WA), Posed(b, X_WB), {}, context),
                   back = distance(Posed(b, X_WB), Posed(a, X_WA), {}, context);
    ASSERT_EQ(d.distance == 0, touch) << n;
    EXPECT_EQ(back.distance == 0, touch);
    if (touch) {
      EXPECT_LT((d.p_WA - d.p_WB).norm(), 1e-11);
      EXPECT_TRUE(trianglesTouchExact(corners(meshA, d.a), X_WA, corners(meshB, d.b), X_WB));
      continue;
    }
    const double truth = test::bruteForceDistance(meshA, X_WA, meshB, X_WB),
                 size = std::max(errorScale(meshA, X_WA), errorScale(meshB, X_WB));
    EXPECT_NEAR(d.distance, truth, 1e-12 * truth) << n;
    EXPECT_NEAR(back.distance, truth, 1e-12 * truth + 4 * kUnit * size) << n;
    const Distance loose = distance(Posed(a, X_WA), Posed(b, X_WB), {0.1, 0.01}, context);
    EXPECT_GE(loose.distance, truth * (1 - 1e-12));
    EXPECT_LE(loose.distance, 1.1 * truth + 0.01 + 1e-10);
  }
}

}  // namespace
}  // namespace corridor
