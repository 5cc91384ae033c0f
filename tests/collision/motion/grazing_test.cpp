#include "tests/collision/motion/grazing.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/motion/certify_motion.h"
#include "tests/collision/motion/bodies.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::certify;
using test::Grazing;

TEST(CertifyMotion, GrazingByConstruction) {
  std::mt19937_64 random(test::testSeed(8));
  const int count = test::casesOf(700, 400'000);
  const std::vector<std::int64_t> targets = test::simdTargets();
  int apart = 0, together = 0, falseFree = 0, falseContact = 0, notFree = 0, notFound = 0;
  for (int n = 0; apart + together < count; ++n) {
    const double size = std::pow(10.0, n % 5 - 2);
    const double amount = std::pow(10.0, -2 - n % 12);
    const double gap = n / 12 % 2 ? amount : -amount;
    const auto feature = static_cast<Grazing::Feature>(n % 7 % Grazing::features);
    const bool slides = n % 3 == 0;
    const Grazing g(random, feature, slides, gap, size);
    if (!g.known) continue;
    (gap > 0 ? apart : together)++;
    hwy::SetSupportedTargetsForTest(targets[static_cast<std::size_t>(n) % targets.size()]);
    QueryContext context;
    MotionOptions options;
    options.tolerance = 1e-7 * size;
    options.earliest = n % 2;
    const MotionResult r = certify(test::bodyOf(g.moving), test::bodyOf(g.fixed),
                                   RigidMotion::spatial(g.from, g.to, {}), options, context);
    if (gap < 0) {
      falseFree += r.verdict == MotionVerdict::free;
      notFound += r.verdict != MotionVerdict::contact && amount > 1e-6;
    } else {
      falseContact += r.verdict == MotionVerdict::contact;
      notFree += r.verdict != MotionVerdict::free && amount > 2e-7;
    }
    if (options.earliest && r.verdict == MotionVerdict::contact) {
      ASSERT_TRUE(r.grazing || r.time - r.certifiedUntil <= options.timeTolerance) << n;
    }
    if (r.verdict == MotionVerdict::undecided) {
      EXPECT_EQ(r.reason, UndecidedReason::clearance) << n;
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_EQ(falseFree, 0);
  EXPECT_EQ(falseContact, 0);
  EXPECT_EQ(notFree, 0) << "a clearance above twice the tolerance is never undecided";
  EXPECT_EQ(notFound, 0);
  EXPECT_GT(apart, count / 4);
  EXPECT_GT(together, count / 4);
}

}  // namespace
}  // namespace corridor
