// Exact contact of convex hulls against the rational simplex method.
#include "collision/convex/exact_contact.h"

#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "tests/collision/convex/hull_pairs.h"
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
    // Whatever a cache holds, rationals decide.
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

}  // namespace
}  // namespace corridor
