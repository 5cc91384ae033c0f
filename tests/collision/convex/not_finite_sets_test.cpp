// Queries of convex sets never claim a separation if a number of a map or of a set is not finite.
#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/convex/simple_polygon.h"
#include "collision/course/exact_contact.h"
#include "collision/course/penetration.h"
#include "collision/course/plane_separation.h"
#include "collision/course/polytope_intersection.h"
#include "collision/course/separating_axes.h"
#include "collision/course/separating_plane.h"
#include "collision/course/signed_distance.h"
#include "collision/course/vclip.h"
#include "tests/support/not_finite.h"

namespace corridor::test {
namespace {

/// Parts of every kind, each within 1 m of the origin.
std::vector<ConvexPart> someParts() {
  const Transform X;
  return {placed(Box{Vec3(1, 0.8, 0.6)}, X), placed(Sphere{0.5}, X), placed(Capsule{0.2, 0.6}, X),
          placed(Cylinder{0.3, 0.7}, X),
          placed(Convex{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}}, X)};
}

Transform farAway() {
  Transform X;
  X.t = Vec3(5, 4, 3);
  return X;
}

/// A pair of parts and their maps.
struct PosedParts {
  ConvexPart a, b;
  Transform X_WA, X_WB;

  template <class Query>
  auto of(const Query& query) const {
    const ConvexSet setA(a), setB(b);
    return query(PosedSet(setA, X_WA), PosedSet(setB, X_WB));
  }
};
void addNumbers(PosedParts& pair, std::vector<double*>& numbers) {
  using test::addNumbers;
  addNumbers(pair.a, numbers), addNumbers(pair.b, numbers);
  addNumbers(pair.X_WA, numbers), addNumbers(pair.X_WB, numbers);
}

TEST(NotFiniteSets, AreNeverSeparated) {
  for (const ConvexPart& a : someParts())
    for (const ConvexPart& b : someParts()) {
      const PosedParts good{a, b, {}, farAway()};
      const auto touch = [](const PosedSet& x, const PosedSet& y) {
        ConvexCache cache;
        return std::pair<bool, bool>(convexSetsTouch(x, y), convexSetsTouch(x, y, &cache));
      };
      const auto distance = [](const PosedSet& x, const PosedSet& y) {
        return convexDistance(x, y);
      };
      const auto range = [](const PosedSet& x, const PosedSet& y) {
        return convexDistanceRange(x, y, 0, 0);
      };
      ASSERT_FALSE(good.of(touch).first || good.of(touch).second);
      ASSERT_TRUE(good.of(distance).lower > 0 && good.of(range).lower > 0);
      forEachNotFinite(good, [&](const PosedParts& bad, const std::string& what) {
        EXPECT_TRUE(bad.of(touch).first) << what;
        EXPECT_TRUE(bad.of(touch).second) << what << ", with a cache";
        EXPECT_FALSE(bad.of(distance).lower > 0) << what;
        EXPECT_FALSE(bad.of(distance).distance > 0) << what;
        EXPECT_FALSE(bad.of(range).lower > 0) << what;
      });
    }
}

TEST(NotFiniteSets, HaveNoDepth) {
  for (const ConvexPart& a : someParts())
    for (const ConvexPart& b : someParts()) {
      const PosedParts good{a, b, {}, {}};
      const auto depth = [](const PosedSet& x, const PosedSet& y) { return penetration(x, y); };
      const auto along = [](const PosedSet& x, const PosedSet& y) {
        return penetrationAlong(x, y, Vec3::UnitX());
      };
      const auto distance = [](const PosedSet& x, const PosedSet& y) {
        return signedDistance(x, y);
      };
      forEachNotFinite(good, [&](const PosedParts& bad, const std::string& what) {
        EXPECT_THROW(bad.of(depth), std::invalid_argument) << what;
        EXPECT_THROW(bad.of(along), std::invalid_argument) << what;
        EXPECT_THROW(bad.of(distance), std::invalid_argument) << what;
      });
    }
  const ConvexPart ball = someParts()[1];
  const ConvexSet set(ball);
  const PosedSet posed(set, {});
  for (const double bad : kNotFinite) {
    EXPECT_THROW(penetration(posed, posed, bad), std::invalid_argument);
    EXPECT_THROW(penetrationAlong(posed, posed, Vec3(0, bad, 1)), std::invalid_argument);
  }
}

const std::vector<Vec3> kTetrahedron{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};

TEST(NotFiniteSets, PolytopesUnderSuchMapsAreRefused) {
  const Polytope polytope(kTetrahedron);
  const PolytopeFeatures features{ConvexSet(polytope)};
  const DobkinKirkpatrick inner(polytope);
  const OuterHierarchy outer(inner);
  struct Maps {
    Transform X_WA, X_WB;
  };
  const auto numbersOf = [](Maps& maps) {
    std::vector<double*> numbers;
    test::addNumbers(maps.X_WA, numbers), test::addNumbers(maps.X_WB, numbers);
    return numbers;
  };
  const auto isNear = [&](const Maps& maps) {
    FeaturePair pair;
    return closestFeatures(features, maps.X_WA, features, maps.X_WB, pair).distance.lower > 0;
  };
  ASSERT_TRUE(isNear({{}, farAway()}));
  forEachNotFinite(Maps{{}, farAway()}, numbersOf, [&](const Maps& bad, const std::string& what) {
    EXPECT_FALSE(claims([&] { return isNear(bad); })) << what;
    EXPECT_THROW(separatingAxis(features, bad.X_WA, features, bad.X_WB), std::invalid_argument)
        << what;
    EXPECT_THROW(convexHullsTouch({ConvexSet(polytope), bad.X_WA}, {ConvexSet(polytope), bad.X_WB}),
                 std::invalid_argument)
        << what;
    EXPECT_THROW(intersection(inner, bad.X_WA, outer, bad.X_WB), std::invalid_argument) << what;
  });
}

TEST(NotFiniteSets, PointsAndHalfSpacesAreRefused) {
  forEachNotFinite(kTetrahedron, [](const std::vector<Vec3>& bad, const std::string& what) {
    EXPECT_THROW(Polytope{bad}, std::invalid_argument) << what;
    EXPECT_THROW(separatingPlane<3>(bad, kTetrahedron), std::invalid_argument) << what;
    EXPECT_THROW(separatingPlane<3>(kTetrahedron, bad), std::invalid_argument) << what;
  });
  const std::vector<Vec2> triangle{Vec2(0, 0), Vec2(1, 0), Vec2(0, 1)};
  forEachNotFinite(triangle, [&](const std::vector<Vec2>& bad, const std::string& what) {
    EXPECT_THROW(ConvexPolygon{bad}, std::invalid_argument) << what;
    EXPECT_THROW(separatingPlane<2>(bad, triangle), std::invalid_argument) << what;
    EXPECT_TRUE(checkSimple(bad)) << what;
  });
  const DobkinKirkpatrick hierarchy{Polytope(kTetrahedron)};
  const Eigen::Vector4d plane(0, 0, 1, 5);
  forEachNotFinite(plane, [&](const Eigen::Vector4d& bad, const std::string& what) {
    const HalfSpace<3> half{bad.head<3>(), bad[3]};
    EXPECT_THROW(planeSeparation(hierarchy, half), std::invalid_argument) << what;
    EXPECT_THROW(sideOfPlane(hierarchy, half), std::invalid_argument) << what;
    EXPECT_THROW(solveLinearProgram<3>(std::vector{half}, Vec3::UnitX()), std::invalid_argument)
        << what;
    EXPECT_THROW(commonPoint<3>(std::vector{half}, std::vector<HalfSpace<3>>{}),
                 std::invalid_argument)
        << what;
  });
  for (const double bad : kNotFinite)
    EXPECT_THROW(solveLinearProgram<3>({}, Vec3(0, bad, 0)), std::invalid_argument);
}

}  // namespace
}  // namespace corridor::test
