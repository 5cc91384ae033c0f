// Tests of V-Clip. Verdicts are compared with those of the rational simplex method. Distances and
// closest features are compared with brute force over all pairs of features, in long double.
#include "collision/course/vclip.h"

#include <cmath>
#include <iostream>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "collision/core/rounding.h"
#include "collision/course/exact_contact.h"
#include "collision/course/separating_axes.h"
#include "tests/collision/convex/hull_pairs.h"
#include "tests/collision/convex/posed_polytopes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::ExactPairs;
using test::Vec3L;

std::vector<Vec3L> cornersOf(const PolytopeFeatures& shape, const Feature& feature,
                             const Transform& X) {
  std::array<std::uint32_t, 3> memory{};
  std::vector<Vec3L> corners;
  for (const std::uint32_t v : shape.corners(feature, memory))
    corners.push_back(test::mappedL(X, shape.vertex(v)));
  return corners;
}

/// Returns the promised error of a distance.
long double allowedError(long double distance, double size) {
  return 1e-12L * distance + 4 * kUnit * size;
}

Feature randomFeature(ExactPairs& make, const PolytopeFeatures& shape) {
  const auto below = [&](std::size_t n) {
    return static_cast<std::uint32_t>(make.pick(static_cast<int>(n)));
  };
  switch (make.pick(3)) {
    case 0:
      return {Feature::Kind::vertex, below(shape.polytope().vertices().size())};
    case 1:
      return {Feature::Kind::edge, below(shape.halfEdges())};
    default:
      return {Feature::Kind::face, below(shape.polytope().faces().size())};
  }
}

double sizeOf(const std::vector<Vec3>& p, const std::vector<Vec3>& q) {
  double size = 0;
  for (const auto* points : {&p, &q})
    for (const Vec3& x : *points) size = std::max(size, x.lpNorm<1>());
  return size;
}

TEST(VClip, AgreesWithAllPairsOfFeatures) {
  ExactPairs make(test::testSeed(61));
  const int pairs = test::casesOf(650, 100'000);
  int meeting = 0, closest = 0, apart = 0, oneRound = 0, mostSteps = 0;
  for (int n = 0; n < pairs; ++n) {
    const Polytope a = make.polytope(make.pick(ExactPairs::kKinds)),
                   b = make.polytope(make.pick(ExactPairs::kKinds));
    const PolytopeFeatures fa(a), fb(b);
    Transform X_WA = make.pose(1), X_WB = make.pose(2.5);
    const bool away = make.pick(4) == 0;
    for (Transform* X : {&X_WA, &X_WB})
      if (away) X->t += Vec3(1e6, -1e6, 5e5);
    const std::vector<Vec3> pointsA = test::mapped(a, X_WA), pointsB = test::mapped(b, X_WB);
    FeaturePair pair{make.pick(4) == 0, randomFeature(make, fa), randomFeature(make, fb), {}};
    const ClosestFeatures found = closestFeatures(fa, X_WA, fb, X_WB, pair);
    // Far from the origin, the mapped points are not exact.
    const bool touch = away ? !separatingAxis(fa, X_WA, fb, X_WB).separated
                            : test::hullRelation<3>(pointsA, pointsB) != HullRelation::disjoint;
    ASSERT_EQ(found.distance.distance == 0, touch) << n;
    ASSERT_EQ(convexHullsTouch({fa.set(), X_WA}, {fb.set(), X_WB}), touch) << n;
    ASSERT_TRUE(fa.has(pair.a) && fb.has(pair.b) && !pair.cold) << n;
    mostSteps = std::max(mostSteps, found.steps);
    meeting += touch;
    if (touch) continue;
    ++apart;
    const double size = 2 * sizeOf(pointsA, pointsB) + 8;
    const long double distance = test::betweenPolytopes(a, X_WA, b, X_WB);
    ASSERT_LE(std::abs(found.distance.distance - distance), allowedError(distance, size)) << n;
    ASSERT_LE(found.distance.lower - distance, 1e-17L * size) << n;
    ASSERT_NEAR((found.distance.p_WB - found.distance.p_WA).norm(), found.distance.distance,
                8 * kUnit * size + 1e-12 * found.distance.distance);
    closest += found.closest;
    oneRound += found.rounds <= 2;
    if (!found.closest) continue;
    const long double ofPair =
        test::betweenFeatures(cornersOf(fa, pair.a, X_WA), cornersOf(fb, pair.b, X_WB));
    ASSERT_LE(std::abs(ofPair - distance), 1e-9L * distance + 1e-13L * size) << n;
  }
  std::cout << meeting << " touch; of " << apart << " apart, the walk found " << closest << ", "
            << oneRound << " were proved at once; at most " << mostSteps << " steps\n";
  EXPECT_GT(meeting, pairs / 10);
  EXPECT_GT(closest, apart * 99 / 100);
  EXPECT_GT(oneRound, apart * 95 / 100);
  EXPECT_LT(mostSteps, 200);
}

/// From every pair of features the query ends at a closest pair. For at least 95 % of the pairs the
/// walk itself reaches it, so GJK need not correct the result.
TEST(VClip, EveryStartReachesTheClosestPair) {
  ExactPairs make(test::testSeed(62));
  const int pairs = test::isStressRun() ? 500 : 20 / test::kSlowdown + 1;
  int starts = 0, mended = 0;
  for (int n = 0; n < pairs; ++n) {
    const Polytope a = make.polytope(0), b = make.polytope(0);
    const PolytopeFeatures fa(a), fb(b);
    const Transform X_WA = make.pose(1), X_WB{make.pose(1).m, X_WA.t + 2.5 * make.vector()};
    const long double distance = test::betweenPolytopes(a, X_WA, b, X_WB);
    if (convexSetsTouch({fa.set(), X_WA}, {fb.set(), X_WB})) continue;
    const auto features = [](const PolytopeFeatures& f) {
      std::vector<Feature> all;
      for (std::uint32_t i = 0; i < f.polytope().vertices().size(); ++i)
        all.push_back({Feature::Kind::vertex, i});
      for (std::uint32_t i = 0; i < f.halfEdges(); ++i) all.push_back({Feature::Kind::edge, i});
      for (std::uint32_t i = 0; i < f.polytope().faces().size(); ++i)
        all.push_back({Feature::Kind::face, i});
      return all;
    };
    for (const Feature& first : features(fa))
      for (const Feature& second : features(fb)) {
        FeaturePair pair{false, first, second, {}};
        const ClosestFeatures found = closestFeatures(fa, X_WA, fb, X_WB, pair);
        ASSERT_LE(std::abs(found.distance.distance - distance), allowedError(distance, 20));
        ASSERT_TRUE(found.closest);
        ASSERT_NEAR(static_cast<double>(test::betweenFeatures(cornersOf(fa, pair.a, X_WA),
                                                              cornersOf(fb, pair.b, X_WB))),
                    found.distance.distance, 1e-12);
        ASSERT_LT(found.steps, 40);
        ++starts;
        // If GJK needed more than one iteration in double and one in double-double, the walk did
        // not end at a closest pair.
        mended += found.rounds > 2;
      }
  }
  std::cout << mended << " of " << starts << " starts led to a local minimum\n";
  EXPECT_GT(starts, 1000);
  EXPECT_LT(mended, starts / 20);
}

/// Along motions in small steps, warm and cold queries must agree, and warm queries must visit few
/// pairs of features.
TEST(VClip, WarmIsColdOnMotions) {
  ExactPairs make(test::testSeed(63));
  const int motions = test::isStressRun() ? 400 : 20 / test::kSlowdown + 2;
  int queries = 0, meeting = 0, atOnce = 0, warmSteps = 0, coldSteps = 0, warmRounds = 0;
  for (int n = 0; n < motions; ++n) {
    const Polytope a = make.polytope(make.pick(ExactPairs::kKinds)),
                   b = make.polytope(make.pick(ExactPairs::kKinds));
    const PolytopeFeatures fa(a), fb(b);
    Transform X = make.pose(2);
    X.m = Eigen::Quaterniond(make.real(), make.real(), make.real(), make.real())
              .normalized()
              .toRotationMatrix();
    const Mat3 turn = Eigen::AngleAxisd(0.005, make.vector().normalized()).toRotationMatrix();
    const Vec3 move = -0.008 * X.t.normalized();  // towards the other polytope, and through it
    FeaturePair warm;
    for (int step = 0; step < 400; ++step) {
      X.m = turn * X.m;
      X.t += move;
      FeaturePair cold;
      const ClosestFeatures first = closestFeatures(fa, {}, fb, X, cold),
                            found = closestFeatures(fa, {}, fb, X, warm);
      ASSERT_EQ(found.distance.distance == 0, first.distance.distance == 0) << n << " " << step;
      ASSERT_LE(std::abs(found.distance.distance - first.distance.distance),
                2 * allowedError(first.distance.distance, 20));
      ASSERT_EQ(convexHullsTouch({a, {}}, {b, X}), found.distance.distance == 0);
      ++queries;
      if (found.distance.distance == 0) {
        ++meeting;
        atOnce += found.rounds == 0;
        ASSERT_EQ(found.distance.p_WA, found.distance.p_WB);
        for (const auto& [polytope, p] :
             {std::pair(&a, found.distance.p_WA),
              std::pair(&b, Vec3(X.m.transpose() * (found.distance.p_WA - X.t)))})
          for (const Polytope::Face& f : polytope->faces()) {
            const Vec3L c = polytope->vertices()[f[0]].cast<long double>();
            const Vec3L normal = (polytope->vertices()[f[1]].cast<long double>() - c)
                                     .cross(polytope->vertices()[f[2]].cast<long double>() - c)
                                     .normalized();
            ASSERT_LT(normal.dot(p.cast<long double>() - c), 1e-8) << n << " " << step;
          }
        continue;
      }
      warmSteps += found.steps;
      warmRounds += found.rounds;
      coldSteps += first.steps;
    }
  }
  const double apart = queries - meeting;
  std::cout << meeting << " of " << queries << " touch; steps apart: warm " << warmSteps / apart
            << " (and " << warmRounds / apart << " rounds of GJK), cold " << coldSteps / apart
            << "\n";
  std::cout << atOnce << " overlaps were proved by the last corners\n";
  EXPECT_GT(atOnce, meeting * 3 / 4);
  EXPECT_GT(meeting, queries / 20);
  EXPECT_LT(meeting, queries * 9 / 10);
  EXPECT_LT(warmSteps, 2 * apart);
  EXPECT_LT(warmSteps, coldSteps);
}

/// At gaps that are so small that `convexSetsTouch` may report contact, the verdict must be exact,
/// and the distance must be within its promised error.
TEST(VClip, GapsBelowTheBandAreNoContact) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  const Polytope box(corners);
  const PolytopeFeatures f(box);
  int inBand = 0;
  for (int k = 40; k <= 51; ++k)
    for (const double shift : {0.0, 0.25, 2.0}) {
      const double gap = std::ldexp(1.0, -k);
      FeaturePair pair;
      const Transform X{Mat3::Identity(), {2 + gap, shift, 0}}, touching{X.m, {2, shift, 0}},
          overlapping{X.m, {2 - gap, shift, 0}};
      const ClosestFeatures found = closestFeatures(f, {}, f, X, pair);
      EXPECT_NEAR(found.distance.distance, gap, 1e-12 * gap + 4 * kUnit * 8) << k;
      EXPECT_GT(found.distance.distance, 0) << k;
      EXPECT_LE(found.distance.lower, gap);
      inBand += convexSetsTouch({box, {}}, {box, X});
      EXPECT_EQ(closestFeatures(f, {}, f, touching, pair).distance.distance, 0) << k;
      EXPECT_EQ(closestFeatures(f, {}, f, overlapping, pair).distance.distance, 0) << k;
      EXPECT_FALSE(convexHullsTouch({box, {}}, {box, X}));
    }
  EXPECT_GT(inBand, 0);  // or no such small gap was tested
}

/// For maps that are not rotations, the query uses GJK, with the same guarantee. If the cache has
/// features that do not exist, the query starts cold.
TEST(VClip, TakesAnyMapAndAnyPair) {
  ExactPairs make(test::testSeed(64));
  int apart = 0;
  for (int n = 0; n < 300; ++n) {
    const Polytope a = make.polytope(0), b = make.polytope(0);
    const PolytopeFeatures fa(a), fb(b);
    Transform X;
    X.m = Mat3::NullaryExpr([&] { return std::round(8 * make.real()) / 4; });
    X.t = 2 * make.vector().unaryExpr([](double x) { return std::round(64 * x) / 64; });
    FeaturePair pair{false, {Feature::Kind::edge, 1'000'000}, {Feature::Kind::face, 1'000'000}, {}};
    const ClosestFeatures found = closestFeatures(fa, {}, fb, X, pair);
    const bool touch =
        test::hullRelation<3>(test::mapped(a, {}), test::mapped(b, X)) != HullRelation::disjoint;
    ASSERT_EQ(found.distance.distance == 0, touch) << n;
    ASSERT_FALSE(found.closest);
    ASSERT_TRUE(fa.has(pair.a) && fb.has(pair.b));
    apart += !touch;
  }
  EXPECT_GT(apart, 30);
  const ConvexPart ball = placed(Sphere{1}, {});
  EXPECT_THROW(PolytopeFeatures{ConvexSet(ball)}, std::invalid_argument);
  EXPECT_THROW(convexHullsTouch({ball, {}}, {ball, {}}), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
