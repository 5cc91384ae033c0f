#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference_obb4.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/collision/queries/true_distances.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::anyPose;
using test::corners;
using test::errorScale;
using test::soup;

TEST(Obb4Distance, SharedWorkloads) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  QueryContext context;
  std::size_t turn = 0;
  int checked = 0;
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    if (!w.hasDistances()) continue;
    ++turn;
    for (std::size_t f = 0; f < std::size(test::kFits); ++f) {
      const auto& [fit, fitName] = test::kFits[f];
      const auto poses = test::posesOfFit(w, name[0] == 'a' ? 1 : 5, f, turn);
      if (poses.empty()) continue;
      const Obb4Tree a(w.a, fit), b(w.b, fit);
      checked += test::expectTrueDistances(w, a, b, poses, fitName, context);
    }
  }
  EXPECT_GT(checked, 1'000 / test::kSlowdown);
}

/// Distances whose squares exceed the range of floats: bodies of 1 mm that are a light second, a
/// light year, and more apart.
TEST(Obb4Distance, FarApart) {
  std::mt19937_64 random(test::testSeed(23));
  for (const double away : {1e3, 3e8, 1e16, 1e25}) {
    const TriangleMesh mesh = soup(random, 200, 0.001);
    const Obb4Tree a(mesh), b(mesh);
    const VolumeTree<Obb> same(mesh);
    Transform X_WB = anyPose(random, 1);
    X_WB.t *= away;
    QueryContext context;
    const Distance d = distance(Posed(a), Posed(b, X_WB), {}, context),
                   reference = distance(Posed(same), Posed(same, X_WB), {}, context);
    const double size = errorScale(corners(mesh, d.b), X_WB);
    EXPECT_NEAR(d.distance, reference.distance, 1e-12 * d.distance + 8 * kUnit * size) << away;
    EXPECT_FALSE(closerThan(Posed(a), Posed(b, X_WB), 0.5 * d.distance, context));
  }
}

TEST(Obb4Distance, AgreesWithBruteForceAndIsSymmetric) {
  std::mt19937_64 random(test::testSeed(22));
  int touching = 0;
  for (int n = 0; n < 300; ++n) {
    TriangleMesh meshA = soup(random, 15, 0.1),
                 meshB = soup(random, 1 + static_cast<int>(random() % 30),
                              n % 5 == 0 ? 0.6
                              : n % 4    ? 0.1
                                         : 0.001);
    const int exponent = n % 11 == 0 ? -300 : n % 11 == 1 ? 300 : 0;
    for (TriangleMesh* m : {&meshA, &meshB})
      for (Vec3& v : m->vertices)
        v = v.unaryExpr([&](double x) { return std::ldexp(x, exponent); });
    const double unit = std::ldexp(1.0, exponent);
    const Obb4Tree a(meshA), b(meshB);
    Transform X_WA = anyPose(random, n % 3 ? 1 : 1e4), X_WB = X_WA;
    X_WB.t += anyPose(random, n % 5 ? 1.5 : 0.2).t;
    X_WA.t *= unit;
    X_WB.t *= unit;
    if (n % 2) X_WB.m = anyPose(random, 1).m;
    if (n % 7 == 0) X_WA.m += 1e-5 * anyPose(random, 1).m;
    QueryContext context;
    const bool touch = interference(Posed(a, X_WA), Posed(b, X_WB), context).has_value();
    const Distance d = distance(Posed(a, X_WA), Posed(b, X_WB), {}, context),
                   back = distance(Posed(b, X_WB), Posed(a, X_WA), {}, context);
    ASSERT_EQ(d.distance == 0, touch) << n;
    EXPECT_EQ(back.distance == 0, touch);
    touching += touch;
    if (touch) {
      EXPECT_TRUE(trianglesTouchExact(corners(meshA, d.a), X_WA, corners(meshB, d.b), X_WB));
      continue;
    }
    const double truth = test::bruteForceDistance(meshA, X_WA, meshB, X_WB),
                 size = std::max(errorScale(meshA, X_WA), errorScale(meshB, X_WB));
    EXPECT_NEAR(d.distance, truth, 1e-12 * truth) << n;
    EXPECT_NEAR(back.distance, truth, 1e-12 * truth + 4 * kUnit * size) << n;
    const Distance loose = distance(Posed(a, X_WA), Posed(b, X_WB), {0.1, 0.01 * unit}, context);
    EXPECT_GE(loose.distance, truth * (1 - 1e-12));
    EXPECT_LE(loose.distance, 1.1 * truth + 0.01 * unit + 1e-10 * truth);
    for (const double factor : {0.5, 0.999, 1.001, 2.0})
      EXPECT_EQ(closerThan(Posed(a, X_WA), Posed(b, X_WB), factor * truth, context), factor > 1)
          << n;
  }
  EXPECT_GT(touching, 20);
  EXPECT_LT(touching, 250);
}

Mat3 turned(int n) {
  return Eigen::AngleAxisd(n, Vec3(1, 2, 3).normalized()).toRotationMatrix();
}

/// A triangle lies above its copy, so its corners project to the copy's boundary. In doubles the
/// projected points seem to be inside the copy; in more precise numbers they are outside.
TEST(Obb4Distance, FeetOnEdges) {
  TriangleMesh low, high;
  const Vec3 up(0, 0, 0.1);
  test::add(low, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  test::add(high, up, up + Vec3(1, 0, 0), up + Vec3(0, 1, 0));
  const Obb4Tree a(low), b(high);
  QueryContext context;
  for (int n = 0; n < 100; ++n) {
    const Transform X{turned(n), Vec3::Zero()};
    EXPECT_NEAR(distance(Posed(a, X), Posed(b, X), {}, context).distance, 0.1, 4 * kUnit) << n;
    EXPECT_TRUE(closerThan(Posed(a, X), Posed(b, X), 0.1 + 4 * kUnit, context)) << n;
  }
}

/// Two bodies with many tips, whose opposite tips have nearly equal distances. Floats cannot decide
/// which tips are closest, and the margins must not exclude the closest pair.
TEST(Obb4Distance, NearTies) {
  for (int n = 0; n < 20; ++n) {
    TriangleMesh low, high;
    for (int i = 0; i < 16; ++i) {
      const Vec3 p(0, 0.01 * i, 0), q = p + Vec3(0, 0, 0.001 + 1e-8 * (7 * i % 16));
      test::add(low, p + Vec3(0.3, 0, -1), p, p + Vec3(-0.2, 0.1, -1));
      test::add(high, q + Vec3(0.3, 0.2, 1), q + Vec3(-0.3, 0.1, 1), q);
    }
    for (TriangleMesh* m : {&low, &high})
      for (Vec3& v : m->vertices) v = turned(n) * v;
    const Obb4Tree a(low), b(high);
    QueryContext context;
    const Distance d = distance(Posed(a), Posed(b), {}, context);
    EXPECT_EQ(d.a, 0U) << n;
    EXPECT_EQ(d.b, 0U) << n;
    EXPECT_NEAR(d.distance, 0.001, 8 * kUnit) << n;  // 2 of the 8 kUnit are for the rounding of the
                                                     // corners
  }
}

/// Gaps of a few rounding errors, and tolerance queries with limits just below the gap: bounds in
/// double alone cannot decide these queries.
TEST(Obb4Distance, CloserThanIsRightUpToFourRoundings) {
  QueryContext context;
  int queries = 0;
  for (int n = 8; n < 4000; n = n * 5 / 4) {
    // Two parallel triangles, at z = 1 and z = 1 + 2n·u; all coordinates are at most 1 + 2n·u.
    const double gap = 2 * n * kUnit;
    TriangleMesh mesh, above;
    mesh.vertices = {Vec3(-1, -1, 1), Vec3(1, -1, 1), Vec3(0, 1, 1)};
    mesh.triangles = {{0, 1, 2}};
    above = mesh;
    for (Vec3& v : above.vertices) v.z() += gap;
    const Obb4Tree a(mesh), b(above);
    LastPair last;  // the search starts from the pair that was found
    EXPECT_EQ(distance(Posed(a), Posed(b), {}, context, &last).distance, gap) << n;
    for (const double below : {4.5, 5.0, 6.0, 8.0}) {
      const double d = gap - below * kUnit;
      EXPECT_FALSE(closerThan(Posed(a), Posed(b), d, context)) << n << ", " << below;
      EXPECT_FALSE(closerThan(Posed(a), Posed(b), d, context, &last)) << n << ", " << below;
      ++queries;
    }
    EXPECT_TRUE(closerThan(Posed(a), Posed(b), gap, context)) << n;
  }
  EXPECT_GT(queries, 80);
  // Under rotations the true distance is known up to 4u·S, the error of `distance`.
  TriangleMesh low, high;
  test::add(low, Vec3(-1, -1, 1), Vec3(1, -1, 1), Vec3(0, 1, 1));
  test::add(high, Vec3(-1, 1, 1 + 0x1p-40), Vec3(1, 1, 1 + 0x1p-40), Vec3(0, -1, 1 + 0x1p-40));
  const Obb4Tree a(low), b(high);
  for (int n = 0; n < 200; ++n) {
    const Transform X{turned(n), Vec3::Zero()};
    const double S = (X.m.cwiseAbs() * Vec3(1, 1, 1 + 0x1p-40)).maxCoeff();
    LastPair last;
    const double found = distance(Posed(a, X), Posed(b, X), {}, context, &last).distance;
    for (double below = -1; below < 12; below += 0.125) {
      const double d = found - below * kUnit * S;
      const bool closer = closerThan(Posed(a, X), Posed(b, X), d, context, &last);
      EXPECT_EQ(closer, closerThan(Posed(a, X), Posed(b, X), d, context)) << n << ", " << below;
      if (below > 8) {
        EXPECT_FALSE(closer) << n << ", " << below;
      }
    }
  }
}

}  // namespace
}  // namespace corridor
