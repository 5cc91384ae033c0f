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

/// Two polytopes of up to 2,000 vertices, of every pair of kinds, under random maps.
struct RandomPair {
  DobkinKirkpatrick a, b;
  Transform X_WA, X_WB;
  double size;

  /// Their centres are at most `nearest`, or for every third pair `farthest`, from the origin.
  RandomPair(RandomPoints& random, int n, double nearest, double farthest)
      : RandomPair(random, n, nearest, farthest,
                   n % 10 == 0 ? 2'000 / test::kSlowdown : 4 + random.below(60)) {}

 private:
  RandomPair(RandomPoints& random, int n, double nearest, double farthest, std::size_t count)
      : a(hierarchyOf(random, static_cast<std::size_t>(n), count)),
        b(hierarchyOf(random, static_cast<std::size_t>(n / 6), count)),
        X_WA(randomPose(random, a, nearest / 2)),
        X_WB(randomPose(random, b, n % 3 ? nearest : farthest)),
        size(sizeOf(a, X_WA, b, X_WB)) {}
};

TEST(HierarchyDescent, DistancesAgreeWithGjk) {
  RandomPoints random(test::testSeed(61));
  int contacts = 0, apart = 0;
  for (int n = 0; n < test::casesOf(300, 5'000); ++n) {
    const auto [a, b, X_WA, X_WB, size] = RandomPair(random, n, 2, 6);
    const ConvexDistance known = convexDistance(PosedSet(a, X_WA), PosedSet(b, X_WB));
    const ConvexDistance found = distanceByDescent(a, X_WA, b, X_WB);
    EXPECT_EQ(found.distance == 0, known.distance == 0) << "pair " << n;
    EXPECT_LE(found.distance, known.distance + 1e-14 * size) << "pair " << n;
    EXPECT_GE(found.distance, known.lower - 1e-15 * size) << "pair " << n;
    EXPECT_LE(found.lower, known.distance + 1e-15 * size) << "pair " << n;
    EXPECT_GE(found.lower, known.distance - 1e-13 * size) << "pair " << n;
    (known.distance == 0 ? contacts : apart) += 1;
  }
  EXPECT_GT(contacts, 20);
  EXPECT_GT(apart, 20);
}

TEST(HierarchyDescent, DirectionalDepthsAgreeWithThePolytopeAlgorithm) {
  RandomPoints random(test::testSeed(62));
  int overlaps = 0, apart = 0, tight = 0;
  for (int n = 0; n < test::casesOf(300, 5'000); ++n) {
    const auto [a, b, X_WA, X_WB, size] = RandomPair(random, n, 1, 3);
    const Vec3 d = random.direction();
    const Penetration known = penetrationAlong(PosedSet(a, X_WA), PosedSet(b, X_WB), d);
    const DepthByDescent found = depthByDescent(a, X_WA, b, X_WB, d);
    if (!(known.upper > 0)) {
      ++apart;
      continue;
    }
    ++overlaps;
    const double close = 1e-8 * known.upper + 1e-12 * size;
    EXPECT_GE(found.upper, known.lower) << "pair " << n;
    EXPECT_LE(found.upper, known.upper + close) << "pair " << n;
    EXPECT_NEAR(found.found, found.upper, close) << "pair " << n;
    // Where the ray begins in the boundary of A − B, the polytope algorithm has no lower bound.
    tight += known.lower > 0;
    if (known.lower > 0) {
      EXPECT_NEAR(found.upper, known.upper, close) << "pair " << n;
    }
    // The normal proves the bound: along it, the moved b begins where a ends.
    EXPECT_GT(found.normal_W.dot(d), 0);
  }
  std::cout << overlaps << " pairs overlap, " << apart << " do not\n";
  EXPECT_GT(overlaps, 50);
  EXPECT_GT(tight, overlaps * 9 / 10);
}

/// Points of a lattice: many normals are those of faces, and parallel faces touch.
TEST(HierarchyDescent, LatticesAgreeWithGjkAndThePolytopeAlgorithm) {
  RandomPoints random(test::testSeed(64));
  const auto lattice = [&](double half) {
    const auto number = [&] {
      return static_cast<double>(random.below(static_cast<std::uint64_t>(2 * half + 1))) - half;
    };
    std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::uint64_t k = 4 + random.below(40); k > 0; --k)
      points.push_back({number(), number(), number()});
    return DobkinKirkpatrick{Polytope(points)};
  };
  int depths = 0, distances = 0;
  for (int n = 0; n < test::casesOf(500, 20'000); ++n) {
    const double half = 1 + static_cast<double>(random.below(8));
    const DobkinKirkpatrick a = lattice(half), b = lattice(half);
    Transform X;
    for (double& t : X.t) t = static_cast<double>(random.below(n % 2 ? 3 : 20));
    const ConvexDistance known = convexDistance(PosedSet(a, {}), PosedSet(b, X));
    const ConvexDistance found = distanceByDescent(a, {}, b, X);
    EXPECT_EQ(found.distance == 0, known.distance == 0) << "pair " << n;
    EXPECT_NEAR(found.distance, known.distance, 1e-11) << "pair " << n;
    distances += known.distance > 0;
    const Vec3 d = n % 4 < 2 ? Vec3::Unit(n % 3) : Vec3(1, n % 5 - 2, n % 3 - 1);
    const Penetration depth = penetrationAlong(PosedSet(a, {}), PosedSet(b, X), d);
    if (depth.lower < 1e-3 || depth.upper > 1e6) continue;
    ++depths;
    const DepthByDescent descent = depthByDescent(a, {}, b, X, d);
    EXPECT_GE(descent.upper, depth.lower) << "pair " << n;
    EXPECT_NEAR(descent.upper, depth.upper, 1e-8 * depth.upper) << "pair " << n;
    EXPECT_NEAR(descent.found, depth.upper, 1e-8 * depth.upper) << "pair " << n;
  }
  std::cout << distances << " pairs are apart, " << depths << " overlap\n";
  EXPECT_GT(distances, 50);
  EXPECT_GT(depths, 100);
}

/// More than four planes meet in the best point of the depth of parts, so rounding hides it. These
/// are pairs of the test above, from its long run.
TEST(HierarchyDescent, DepthsOfPartsWhereManyPlanesMeet) {
  struct Pair {
    std::vector<Vec3> a, b;
    Vec3 t, d;
  };
  for (const auto& [pointsA, pointsB, t, d] : std::vector<Pair>{{{{0, 2, 2},
                                                                  {-2, -2, 2},
                                                                  {-2, 1, 2},
                                                                  {1, 2, -1},
                                                                  {2, -2, 2},
                                                                  {2, 2, 1},
                                                                  {-2, -1, -1},
                                                                  {-2, -2, -2},
                                                                  {2, -2, -1}},
                                                                 {{-2, 1, 0},
                                                                  {2, 2, 2},
                                                                  {-2, -2, -1},
                                                                  {2, -2, 2},
                                                                  {1, -2, -1},
                                                                  {2, -1, -2},
                                                                  {0, 1, 2},
                                                                  {-1, 2, -1},
                                                                  {-1, 0, -2},
                                                                  {1, -1, -2},
                                                                  {-2, -1, 2}},
                                                                 {2, 1, 0},
                                                                 {1, -2, 0}},
                                                                {{{0, 1, 1},
                                                                  {1, 1, 0},
                                                                  {1, -1, -1},
                                                                  {1, 1, 1},
                                                                  {-1, 1, 0},
                                                                  {0, 1, -1},
                                                                  {0, -1, -1},
                                                                  {0, -1, 1},
                                                                  {-1, -1, 0},
                                                                  {1, -1, 1},
                                                                  {1, 0, -1}},
                                                                 {{0, 1, 1},
                                                                  {-1, -1, 1},
                                                                  {1, -1, -1},
                                                                  {1, -1, 1},
                                                                  {1, 1, -1},
                                                                  {-1, 1, -1},
                                                                  {-1, 1, 0},
                                                                  {-1, 0, 1},
                                                                  {1, 1, 1},
                                                                  {-1, -1, -1}},
                                                                 {1, 0, 1},
                                                                 {1, 1, 1}}}) {
    for (const double scale : {0x1p-100, 1.0, 0x1p60, 0x1p100}) {
      auto scaledA = pointsA, scaledB = pointsB;
      for (auto* points : {&scaledA, &scaledB})
        for (Vec3& p : *points) p *= scale;
      const DobkinKirkpatrick a{Polytope(scaledA)}, b{Polytope(scaledB)};
      Transform X;
      X.t = scale * t;
      const Penetration known = penetrationAlong(PosedSet(a, {}), PosedSet(b, X), d);
      EXPECT_NEAR(depthByDescent(a, {}, b, X, d).upper, known.upper, 1e-8 * known.upper) << scale;
    }
  }
}

DobkinKirkpatrick boxHierarchy(const Vec3& lower, const Vec3& size) {
  std::vector<Vec3> points;
  for (const double x : {0, 1})
    for (const double y : {0, 1})
      for (const double z : {0, 1}) points.push_back(lower + size.cwiseProduct(Vec3(x, y, z)));
  return DobkinKirkpatrick{Polytope(points)};
}

TEST(HierarchyDescent, TheUpperBoundOfSmallAndLargeOverlaps) {
  const Vec3 x = Vec3::UnitX();
  for (int k = 30; k <= 53; ++k) {
    const double overlap = std::ldexp(1, -k);
    const DobkinKirkpatrick a = boxHierarchy({0, 0, 0}, {1, 1, 1});
    const DobkinKirkpatrick b = boxHierarchy({1 - overlap, 0.25, 0.3125}, {1, 0.5, 0.5});
    EXPECT_GE(depthByDescent(a, {}, b, {}, x).upper, overlap);
    EXPECT_LE(depthByDescent(a, {}, b, {}, x).upper, overlap + 1e-13);
    for (const double far : {1e3, 1e6}) {
      Transform X;
      X.t = {far, 0, 0};
      EXPECT_GE(depthByDescent(a, X, b, X, x).upper, overlap);
    }
  }
  for (const double size : {1e-200, 1e155, 1e300}) {
    const DobkinKirkpatrick a = boxHierarchy({0, 0, 0}, size * Vec3(1, 1, 1));
    const DobkinKirkpatrick b = boxHierarchy({size / 2, size / 4, size / 4}, size * Vec3(1, 1, 1));
    EXPECT_GE(depthByDescent(a, {}, b, {}, x).upper, size / 2);
  }
  Transform apart;
  apart.t = {1.5, 0, 0};
  const DobkinKirkpatrick a = boxHierarchy({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(depthByDescent(a, {}, a, apart, x).upper, 0);
  EXPECT_NEAR(depthByDescent(a, {}, a, apart, -x).upper, 2.5, 1e-13) << "b hits a on its way";
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

TEST(HierarchyDescent, ADirectionOfZeroAndMapsThatAreNotFiniteAreRefused) {
  RandomPoints random(1);
  const DobkinKirkpatrick a = hierarchyOf(random, 0, 10);
  EXPECT_THROW(depthByDescent(a, {}, a, {}, Vec3::Zero()), std::invalid_argument);
  EXPECT_THROW(depthByDescent(a, {}, a, {}, Vec3(0, NAN, 1)), std::invalid_argument);
  for (const double bad : {double{NAN}, HUGE_VAL}) {
    Transform moved, turned;
    moved.t.x() = bad;
    turned.m(0, 1) = bad;
    for (const Transform& X : {moved, turned}) {
      EXPECT_THROW(depthByDescent(a, X, a, {}, Vec3::UnitX()), std::invalid_argument);
      EXPECT_THROW(depthByDescent(a, {}, a, X, Vec3::UnitX()), std::invalid_argument);
      EXPECT_EQ(distanceByDescent(a, X, a, {}).lower, 0);
      EXPECT_EQ(distanceByDescent(a, {}, a, X).lower, 0);
    }
  }
}

}  // namespace
}  // namespace corridor
