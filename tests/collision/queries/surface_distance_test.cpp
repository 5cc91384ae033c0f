#include "collision/queries/surface_distance.h"

#include <random>

#include <gtest/gtest.h>

#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// If the options allow an error, the search may stop at a distance above the true distance. But
/// the lower bound that it reports as proved must not be above the true distance.
TEST(SurfaceDistance, WhatIsProvedIsNotAboveTheTrueDistance) {
  std::mt19937_64 random(test::testSeed(27));
  for (const TreeKind trees : {TreeKind::obb4, TreeKind::obbBinary, TreeKind::sphere}) {
    int loose = 0;  // results well above the true distance
    for (int n = 0; n < 200; ++n) {
      const Body a("a", test::soup(random, 60, 0.1)), b("b", test::soup(random, 60, 0.1));
      Transform X_WB = test::anyPose(random, 1);
      X_WB.t[0] += 4;
      QueryContext exact;
      const double truth = surfaceDistance(Posed(a), Posed(b, X_WB), {}, exact, trees).distance;
      for (const DistanceOptions& options :
           {DistanceOptions{}, {0.2, 0}, {1, 0}, {0, 0.5}, {0.3, 0.3}}) {
        QueryContext context;
        const Distance measured =
            surfaceDistance(Posed(a), Posed(b, X_WB), options, context, trees);
        const double proved =
            distanceLowerBound(Posed(a), Posed(b, X_WB), measured, options, context, trees);
        ASSERT_LE(proved, truth * (1 + 1e-12)) << n;
        loose += measured.distance > 1.02 * truth;
        if (truth > 1 && options.relative == 0 && options.absolute == 0) {
          ASSERT_GE(proved, truth * (1 - 1e-11)) << n;
        }
      }
    }
    EXPECT_GT(loose, 10) << "no search stopped early: the test tested nothing";
  }
}

}  // namespace
}  // namespace corridor
