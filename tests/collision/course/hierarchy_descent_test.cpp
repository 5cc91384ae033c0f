#include "collision/course/hierarchy_descent.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/course/penetration.h"
#include "tests/collision/convex/random_points.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::RandomPoints;

DobkinKirkpatrick hierarchyOf(RandomPoints& random, std::size_t kind, std::size_t count) {
  std::vector<Vec3> points = random.points(kind, count);
  points.push_back({0, 0, -2});  // so that the points of no kind are flat
  points.push_back({1, 0, -3});
  return DobkinKirkpatrick{Polytope(points)};
}

/// Returns a random pose that puts the polytope's centre at a distance of `far` from the origin.
Transform randomPose(RandomPoints& random, const DobkinKirkpatrick& of, double far) {
  Transform X;
  X.m = Eigen::AngleAxisd(3 * random.real(), random.direction()).toRotationMatrix();
  X.t = far * random.direction() - X.m * of.polytope().center();
  return X;
}

double sizeOf(const DobkinKirkpatrick& a, const Transform& X_WA, const DobkinKirkpatrick& b,
              const Transform& X_WB) {
  return PosedSet(a, X_WA).reach() + X_WA.t.norm() + PosedSet(b, X_WB).reach() + X_WB.t.norm();
}

TEST(HierarchyDescent, DistancesAgreeWithGjk) {
  RandomPoints random(test::testSeed(61));
  int contacts = 0, apart = 0;
  for (int n = 0; n < test::casesOf(300, 5'000); ++n) {
    const std::size_t count = n % 10 == 0 ? 2'000 / test::kSlowdown : 4 + random.below(60);
    const DobkinKirkpatrick a = hierarchyOf(random, static_cast<std::size_t>(n), count);
    const DobkinKirkpatrick b = hierarchyOf(random, static_cast<std::size_t>(n / 6), count);
    const Transform X_WA = randomPose(random, a, 1), X_WB = randomPose(random, b, n % 3 ? 2 : 6);
    const double size = sizeOf(a, X_WA, b, X_WB);
    const ConvexDistance known = convexDistance(PosedSet(a, X_WA), PosedSet(b, X_WB));
    const ConvexDistance found = distanceByDescent(a, X_WA, b, X_WB);
    EXPECT_EQ(found.distance == 0, known.distance == 0) << "pair " << n;
    EXPECT_NEAR(found.distance, known.distance, 1e-14 * size) << "pair " << n;
    EXPECT_LE(found.lower, known.distance + 1e-15 * size) << "pair " << n;
    EXPECT_GE(found.lower, known.distance - 1e-13 * size) << "pair " << n;
    (known.distance == 0 ? contacts : apart) += 1;
  }
  EXPECT_GT(contacts, 20);
  EXPECT_GT(apart, 20);
}

TEST(HierarchyDescent, DirectionalDepthsAgreeWithThePolytopeAlgorithm) {
  RandomPoints random(test::testSeed(62));
  int overlaps = 0, apart = 0;
  for (int n = 0; n < test::casesOf(300, 5'000); ++n) {
    const std::size_t count = n % 10 == 0 ? 1'000 / test::kSlowdown : 4 + random.below(60);
    const DobkinKirkpatrick a = hierarchyOf(random, static_cast<std::size_t>(n), count);
    const DobkinKirkpatrick b = hierarchyOf(random, static_cast<std::size_t>(n / 6), count);
    const Transform X_WA = randomPose(random, a, 0.5), X_WB = randomPose(random, b, n % 3 ? 1 : 3);
    const double size = sizeOf(a, X_WA, b, X_WB);
    const Vec3 d = random.direction();
    const Penetration known = penetrationAlong(PosedSet(a, X_WA), PosedSet(b, X_WB), d);
    const DepthByDescent found = depthByDescent(a, X_WA, b, X_WB, d);
    if (!(known.upper > 0)) {
      ++apart;
      continue;
    }
    ++overlaps;
    EXPECT_GE(found.upper, known.lower) << "pair " << n;
    EXPECT_NEAR(found.upper, known.upper, 1e-8 * known.upper + 1e-12 * size) << "pair " << n;
    EXPECT_NEAR(found.found, known.upper, 1e-8 * known.upper + 1e-12 * size) << "pair " << n;
    // The normal proves the bound: along it, the moved b begins where a ends.
    EXPECT_GT(found.normal_W.dot(d), 0);
  }
  std::cout << overlaps << " pairs overlap, " << apart << " do not\n";
  EXPECT_GT(overlaps, 50);
}

/// Only a few pyramids of each level are tested, however many vertices there are.
TEST(HierarchyDescent, TestsFewPyramids) {
  RandomPoints random(test::testSeed(63));
  for (const std::size_t count : {100u, 1'000u, 10'000u / test::kSlowdown}) {
    const DobkinKirkpatrick a = hierarchyOf(random, 0, count), b = hierarchyOf(random, 0, count);
    int most = 0;
    for (int n = 0; n < 20; ++n) {
      int pieces = 0;
      distanceByDescent(a, {}, b, randomPose(random, b, 8), &pieces);
      most = std::max(most, pieces);
    }
    std::cout << count << " vertices, " << a.levels() << " levels: at most " << most
              << " pairs of pyramids\n";
    EXPECT_LE(most, static_cast<int>(a.levels() * b.levels()));
  }
}

TEST(HierarchyDescent, ADirectionOfZeroIsRefused) {
  RandomPoints random(1);
  const DobkinKirkpatrick a = hierarchyOf(random, 0, 10);
  EXPECT_THROW(depthByDescent(a, {}, a, {}, Vec3::Zero()), std::invalid_argument);
  EXPECT_THROW(depthByDescent(a, {}, a, {}, Vec3(0, NAN, 1)), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
