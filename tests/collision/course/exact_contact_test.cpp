// Compares exact contact of convex hulls with the rational simplex method.
#include "collision/course/exact_contact.h"

#include <iostream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "tests/collision/convex/hull_pairs.h"
#include "tests/collision/convex/posed_polytopes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

TEST(ExactContact, AgreesWithTheRationalSimplexMethod) {
  test::HullPairs<3> make(test::testSeed(81));
  const int pairs = test::isStressRun() ? 100'000 : 1000 / test::kSlowdown;
  int touching = 0, tooClose = 0;
  for (int n = 0; n < pairs; ++n) {
    const auto [p, q] = make.next();
    const ConvexPart a{p, 0, false}, b{q, 0, false};
    const bool expected = test::hullRelation<3>(p, q) != HullRelation::disjoint;
    ASSERT_EQ(convexHullsTouch({a, {}}, {b, {}}), expected) << n;
    // The verdict must be that of the oracle, whatever the cache contains.
    ConvexCache wrong;
    wrong.count = 4;
    for (auto& corner : wrong.corner) corner = {static_cast<std::uint32_t>(n % 9), 0, {0, 0, 1}};
    if (n % 10 == 0) {
      ASSERT_EQ(confirmContact({a, {}}, {b, {}}, wrong), expected) << n;
    }
    touching += expected;
    tooClose += !expected && convexSetsTouch({a, {}}, {b, {}});
  }
  std::cout << touching << " of " << pairs << " touch; GJK takes " << tooClose
            << " more for touching\n";
  EXPECT_GT(touching, pairs / 10);
  EXPECT_GT(tooClose, 0);
}

/// Every pair is decided in rationals, because the cache proves nothing.
TEST(ExactContact, AgreesUnderMaps) {
  test::ExactPairs make(test::testSeed(82));
  int touching = 0;
  const int pairs = 200 / test::kSlowdown;
  for (int n = 0; n < pairs; ++n) {
    const Polytope first = make.polytope(make.pick(test::ExactPairs::kKinds)),
                   second = make.polytope(make.pick(test::ExactPairs::kKinds));
    const Transform X_WA = make.pose(1), X_WB = make.pose(1.5);
    const ConvexPart a{{first.vertices().begin(), first.vertices().end()}, 0, false},
        b{{second.vertices().begin(), second.vertices().end()}, 0, false};
    const bool expected =
        test::hullRelation<3>(test::mapped(first, X_WA), test::mapped(second, X_WB)) !=
        HullRelation::disjoint;
    ASSERT_EQ(confirmContact({a, X_WA}, {b, X_WB}, ConvexCache{}), expected) << n;
    ASSERT_EQ(convexHullsTouch({a, X_WA}, {b, X_WB}), expected) << n;
    touching += expected;
  }
  EXPECT_TRUE(touching > 0 && touching < pairs) << touching;
}

TEST(ExactContact, RefusesSpheresThatMayTouch) {
  const ConvexPart ball{{Vec3::Zero()}, 1, false};
  const Transform far{Mat3::Identity(), {10, 0, 0}}, near{Mat3::Identity(), {1, 0, 0}};
  EXPECT_THROW(convexHullsTouch({ball, {}}, {ball, near}), std::invalid_argument);
  EXPECT_THROW(confirmContact({ball, {}}, {ball, far}, ConvexCache{}), std::invalid_argument);
  EXPECT_FALSE(convexHullsTouch({ball, {}}, {ball, far})) << "GJK proves them to be apart";
}

}  // namespace
}  // namespace corridor
