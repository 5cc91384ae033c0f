// Distance queries with a limit: `DistanceOptions::upTo`.
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "collision/hierarchy/obb4_tree.h"
#include "collision/queries/distance.h"
#include "collision/queries/distance_obb4.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::anyPose;

/// Compares queries whose limit is below or above the distance with the query without a limit.
template <class Tree>
void compare(const Tree& a, const Tree& b, std::mt19937_64& random, int& below, int& above) {
  std::uint64_t wholeWork = 0, briefWork = 0;
  int infinite = 0;
  for (int n = 0; n < 40; ++n) {
    const Transform X_WA = anyPose(random, 1);
    const Transform X_WB{anyPose(random, 1).m, X_WA.t + anyPose(random, n % 4 ? 2 : 0.5).t};
    QueryContext context;
    const auto query = [&](const DistanceOptions& options) {
      return distance(Posed(a, X_WA), Posed(b, X_WB), options, context);
    };
    const double whole = query({}).distance;
    for (const double relative : {0.0, 1e-3, 0.5})
      for (const double share : {0.0, 0.3, 1 - 1e-9, 1.0, 1 + 1e-9, 1.7}) {
        DistanceOptions options{.relative = relative};
        options.upTo = share * whole;
        context.counters = {};
        const double found = query(options).distance;
        if (whole == 0 || share >= 1) {
          ++above;
          EXPECT_GE(found, whole * (1 - 2e-12));
          EXPECT_LE(found, whole * (1 + relative) * (1 + 2e-12) + 1e-14) << share;
        } else {
          ++below;
          EXPECT_GE(found, whole * (1 - 2e-12)) << "no distance that is too short";
          infinite += found == std::numeric_limits<double>::infinity();
        }
      }
    if (whole < 0.1) continue;
    context.counters = {};
    query({});
    wholeWork += context.counters.work();
    context.counters = {};
    DistanceOptions brief;
    brief.upTo = 1e-3;
    EXPECT_EQ(query(brief).distance, std::numeric_limits<double>::infinity());
    briefWork += context.counters.work();
  }
  // A small limit must save work, and some limits must be below the distance.
  EXPECT_LT(2 * briefWork, wholeWork);
  EXPECT_GT(infinite, 0);
}

template <class Volume>
class DistanceUpTo : public testing::Test {};
TYPED_TEST_SUITE(DistanceUpTo, test::Volumes, test::VolumeNames);

TYPED_TEST(DistanceUpTo, IsTheDistanceOrInfinite) {
  std::mt19937_64 random(test::testSeed(2520));
  using Tree = VolumeTree<TypeParam>;
  const std::vector<ConvexPart> parts = test::parts(random, 20, 0.1);
  int below = 0, above = 0;
  compare(Tree(test::soup(random, 60, 0.1)), Tree(test::soup(random, 60, 0.1)), random, below,
          above);
  compare(Tree(test::soup(random, 60, 0.1)), Tree(parts, {}), random, below, above);
  EXPECT_GT(below, 100);
  EXPECT_GT(above, 100);
}

TEST(DistanceUpTo4, IsTheDistanceOrInfinite) {
  std::mt19937_64 random(test::testSeed(2521));
  const auto parts = std::make_shared<const std::vector<ConvexPart>>(test::parts(random, 20, 0.1));
  int below = 0, above = 0;
  compare(Obb4Tree(test::soup(random, 300, 0.05)), Obb4Tree(test::soup(random, 300, 0.05)), random,
          below, above);
  compare(Obb4Tree(test::soup(random, 300, 0.05)), Obb4Tree(parts), random, below, above);
  EXPECT_GT(below, 100);
  EXPECT_GT(above, 100);
}

}  // namespace
}  // namespace corridor
