// Tests queries of polytopes: the answers must be the same for every way to find the farthest
// vertex, and with and without caches.
#include <cmath>
#include <iostream>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/core/rounding.h"
#include "collision/course/dobkin_kirkpatrick.h"
#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Touching;

/// A polytope in all three forms, which differ in how the farthest vertex is found.
struct Forms {
  DobkinKirkpatrick hierarchy;
  ConvexPart part;

  explicit Forms(const std::vector<Vec3>& points) : hierarchy{Polytope(points)} {
    const auto vertices = hierarchy.polytope().vertices();
    part.points.assign(vertices.begin(), vertices.end());
  }
  ConvexSet form(int i) const {
    if (i == 0) return part;
    return i == 1 ? ConvexSet(hierarchy.polytope()) : ConvexSet(hierarchy);
  }
};

Forms randomPolytope(Touching& make, int count) {
  std::vector<Vec3> points;
  const Vec3 size = make.pick(3) ? Vec3(1, 1, 1) : Vec3(1, 0.1, 0.001);
  for (int i = 0; i < count; ++i) points.push_back(make.vector().normalized().cwiseProduct(size));
  return Forms(points);
}

Transform pose(Touching& make, const Vec3& t) {
  const Eigen::Quaterniond q(make.real(), make.real(), make.real(), make.real());
  return {q.normalized().toRotationMatrix(), t};
}

/// Returns the tolerance for comparing two distances: the sum of their promised errors.
double allowed(double distance, double size) {
  return 2 * (1e-12 * distance + 4 * kUnit * size);
}

TEST(PolytopeQueries, EveryFormGivesTheSameAnswer) {
  Touching make(test::testSeed(51));
  const int pairs = test::isStressRun() ? 20'000 : 1000 / test::kSlowdown;
  int meeting = 0;
  for (int n = 0; n < pairs; ++n) {
    const Forms a = randomPolytope(make, 4 + make.pick(60)),
                b = randomPolytope(make, 4 + make.pick(60));
    const double far = n % 3 ? 1.5 : 1e3;
    const Transform X_WA = pose(make, far * make.vector());
    const Transform X_WB = pose(make, X_WA.t + 1.2 * make.vector());
    const double size = 4 * (X_WA.t.norm() + 3);
    const ConvexDistance expected = convexDistance({a.part, X_WA}, {b.part, X_WB});
    meeting += expected.distance == 0;
    for (int i = 1; i < 9; ++i) {
      const PosedSet setA(a.form(i / 3), X_WA), setB(b.form(i % 3), X_WB);
      const ConvexDistance found = convexDistance(setA, setB);
      EXPECT_LE(std::abs(found.distance - expected.distance), allowed(expected.distance, size))
          << n;
      EXPECT_LE(found.lower, expected.distance + allowed(expected.distance, size)) << n;
      EXPECT_EQ(convexSetsTouch(setA, setB), found.distance == 0) << n;
    }
  }
  EXPECT_GT(meeting, pairs / 10);
}

/// Whatever a cache contains, it changes no verdict, and no distance beyond the distance's error.
TEST(PolytopeQueries, CachesDoNotChangeAnswers) {
  Touching make(test::testSeed(52));
  const int runs = test::isStressRun() ? 500 : 30 / test::kSlowdown + 2;
  int meeting = 0, queries = 0;
  for (int n = 0; n < runs; ++n) {
    const Forms a = randomPolytope(make, 4 + make.pick(100)),
                b = randomPolytope(make, 4 + make.pick(100));
    ConvexCache contact, distance;
    Transform X = pose(make, 1.5 * make.vector());
    const Vec3 axis = make.vector().normalized(), move = 0.01 * make.vector();
    for (int step = 0; step < 60; ++step) {
      X.m = Eigen::AngleAxisd(0.01, axis).toRotationMatrix() * X.m;
      X.t += move;
      if (step == 40) X = pose(make, make.vector());  // the cache is of no use here
      const PosedSet setA(a.form(step % 3), {}), setB(b.form(n % 3), X);
      const ConvexDistance cold = convexDistance(setA, setB),
                           warm = convexDistance(setA, setB, 0, 0, &distance);
      ASSERT_LE(std::abs(warm.distance - cold.distance), allowed(cold.distance, 20))
          << n << " " << step;
      ASSERT_LE(warm.lower, cold.distance + allowed(cold.distance, 20)) << n << " " << step;
      ASSERT_EQ(convexSetsTouch(setA, setB, &contact), cold.distance == 0) << n << " " << step;
      meeting += cold.distance == 0;
      ++queries;
    }
  }
  std::cout << meeting << " of " << queries << " touch\n";
  EXPECT_GT(meeting, queries / 20);
  EXPECT_LT(meeting, queries * 19 / 20);
  // A cache of other sets, which has indices of points that do not exist, is ignored.
  const ConvexPart box = placed(Box{{1, 1, 1}}, {});
  ConvexCache wrong;
  wrong.count = 3;
  for (auto& corner : wrong.corner) corner = {1000, 7, {0, 0, 1}};
  EXPECT_EQ(convexDistance({box, {}}, {box, {Mat3::Identity(), {3, 0, 0}}}, 0, 0, &wrong).distance,
            2);
}

}  // namespace
}  // namespace corridor
