#include "collision/convex/point_columns.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/convex/convex_distance.h"
#include "collision/convex/enclosing_hull.h"
#include "collision/convex/polytope.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using PointColumnsOnEveryTarget = test::EveryTarget;

/// The kernels agree with loops over all points in the same rounding, bit for bit.
TEST_P(PointColumnsOnEveryTarget, AreThoseOfALoop) {
  std::mt19937_64 random(test::testSeed(91));
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  for (int n = 1; n < 40; ++n)
    for (int k = 0; k < 20; ++k) {
      std::vector<Vec3> points;
      for (int i = 0; i < n; ++i)
        points.push_back(i % 5 == 4 ? points[std::size_t(i) / 2] : vector());
      const PointColumns columns(points);
      const Vec3 m = k % 4 == 0 ? Vec3(Vec3::UnitX()) : vector(), v = vector();
      const double shift = unit(random);
      std::uint32_t farthest = 0;
      double highest = -HUGE_VAL, least = HUGE_VAL;
      for (std::uint32_t i = 0; i < points.size(); ++i) {
        const Vec3& p = points[i];
        const double along = p[0] * m[0] + p[1] * m[1] + p[2] * m[2];
        const double moved = p[0] * v[0] + p[1] * v[1] + p[2] * v[2];
        if (along > highest) highest = along, farthest = i;
        least = std::min(least, along - std::abs(moved + shift));
      }
      ASSERT_EQ(columns.farthest(m), farthest) << n << " points";
      ASSERT_EQ(columns.leastAround(m, v, shift), least) << n << " points";
    }
  EXPECT_TRUE(std::isnan(PointColumns({Vec3::Zero()}).leastAround(Vec3(0, NAN, 0), {1, 1, 1}, 0)));
}

INSTANTIATE_TEST_SUITE_P(All, PointColumnsOnEveryTarget, testing::ValuesIn(test::simdTargets()),
                         test::targetName);

TriangleMesh meshOf(const Polytope& hull) {
  TriangleMesh mesh;
  mesh.vertices.assign(hull.vertices().begin(), hull.vertices().end());
  mesh.triangles.assign(hull.faces().begin(), hull.faces().end());
  return mesh;
}

TEST(EnclosingHull, OnlyOfMeshesThatItFits) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  TriangleMesh cube = meshOf(Polytope(corners));
  ASSERT_TRUE(enclosingHull(cube));
  EXPECT_EQ(enclosingHull(cube)->points.points().size(), 8u);
  TriangleMesh room = cube;  // seen from inside
  for (auto& t : room.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(enclosingHull(room));
  cube.vertices.emplace_back(9, 9, 9);        // in no triangle
  cube.vertices.push_back(cube.vertices[0]);  // the same point again
  cube.triangles.push_back({9, cube.triangles[0][1], cube.triangles[0][2]});
  EXPECT_EQ(enclosingHull(cube)->points.points().size(), 8u);
}

/// A mesh of many vertices gets a hull of grid cells, which contains it and does not stick out far.
TEST(EnclosingHull, ContainsMeshesOfManyVertices) {
  std::mt19937_64 random(test::testSeed(92));
  std::normal_distribution<double> normal;
  std::size_t most = 0;
  for (const int count : {1000, 1100, 3000, 12'000}) {
    std::vector<Vec3> many;
    for (int i = 0; i < count; ++i)
      many.push_back(Vec3(7, -3, 1) +
                     Vec3(normal(random), 0.3 * normal(random), normal(random)).normalized());
    const TriangleMesh mesh = meshOf(Polytope(many));
    auto hull = enclosingHull(mesh);
    ASSERT_TRUE(hull);
    most = std::max(most, hull->points.points().size());
    EXPECT_LE(hull->points.points().size(), 1024u);
    EXPECT_EQ(hull->radius == 0, mesh.vertices.size() <= 1024) << mesh.vertices.size();
    EXPECT_LT(hull->radius, 0.12);
    for (int i = 0; i < 200; ++i) {
      const Vec3 n = Vec3(normal(random), normal(random), normal(random)).normalized();
      double highest = -HUGE_VAL;
      for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t) highest = std::max(highest, n.dot(mesh.vertices[v]));
      const double own = n.dot(hull->points.points()[hull->points.farthest(n)]) + hull->radius;
      EXPECT_GE(own, highest - 1e-14);
      EXPECT_LE(own, highest + 2 * hull->radius + 1e-14);
    }
  }
  EXPECT_GT(most, 100u);
}

/// A hull of fewer points contains each of the points of the other one: the distance from the hull
/// of the points that are left, in double-double, is at most the radius.
TEST(EnclosingHull, OfFewerPointsContainsAllOthers) {
  std::mt19937_64 random(test::testSeed(93));
  std::normal_distribution<double> normal;
  for (const int count : {150, 300, 900}) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i)
      points.push_back(Vec3(7, -3, 1) +
                       0.1 * Vec3(normal(random), normal(random), 3 * normal(random)).normalized());
    const EnclosingHull whole{PointColumns(points), 1e-3}, thin = thinned(whole);
    if (count < 200) {
      EXPECT_EQ(thin.points.points().size(), points.size());
      EXPECT_EQ(thin.radius, 1e-3);
      continue;
    }
    EXPECT_LT(thin.points.points().size(), points.size());
    EXPECT_LT(thin.radius, 1e-3 + 0.2 / 1024);
    double farthest = 0;
    const ConvexSet kept(thin.points);
    for (const Vec3& p : points) {
      const ConvexPart point{.points = {p}};
      farthest = std::max(
          farthest, convexDistance({ConvexSet(point), Transform()}, {kept, Transform()}).distance);
    }
    EXPECT_LE(farthest, thin.radius - 1e-3);
    EXPECT_GT(farthest, 0) << "points are left out that are corners of the hull";
  }
}

}  // namespace
}  // namespace corridor
