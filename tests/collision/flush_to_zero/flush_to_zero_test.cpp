// Proofs must hold under flush-to-zero and denormals-are-zero. This program is linked with
// -ffast-math, which sets both before `main`.
#include <random>

#include <gtest/gtest.h>

#include "collision/core/floating_point.h"
#include "collision/motion/check_certificate.h"
#include "tests/collision/motion/bodies.h"
#include "tests/collision/motion/grazing.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// The least normal number; volatile, so that the compiler does not halve it itself.
volatile double least = 0x1p-1022;

TEST(FlushToZero, IsSetFromTheStart) {
#if defined(__x86_64__)
  EXPECT_EQ(least / 2, 0);
#endif
  EXPECT_EQ(floatingPoint(), FloatingPoint::standard) << "it is allowed";
}

TEST(FlushToZero, GrazingEdgesAreRight) {
  std::mt19937_64 random(test::testSeed(5));
  int known = 0, audited = 0;
  for (int n = 0; n < 3'000; ++n) {
    const double gap = (n % 2 ? 1 : -1) * std::pow(10.0, -2 - n % 12);
    // Every tenth case is so small that squares, or even lengths, become 0. For these cases `free`
    // is not required.
    const double size = std::pow(10.0, n % 10 ? 6 - n % 13 : -100 - n % 210);
    const auto feature = static_cast<test::Grazing::Feature>(n % test::Grazing::features);
    const test::Grazing g(random, feature, n % 5 == 0, gap, size);
    if (!g.known) continue;
    ++known;
    const Body fixed = test::bodyOf(g.fixed), moving = test::bodyOf(g.moving);
    RigidEdge edge(RigidMotion::spatial(g.from, g.to, {}));
    const MotionPair pair{&fixed, &moving};
    MotionOptions options;
    options.tolerance = std::max(1e-7 * size, 1e-300);
    QueryContext context;
    MotionCertificate certificate;
    const MotionResult result = certifyMotion(edge, {&pair, 1}, options, context, &certificate);
    if (gap < 0) {
      ASSERT_NE(result.verdict, MotionVerdict::free) << n;
    } else if (size > 1e-7 && gap * size > 2 * options.tolerance) {
      ASSERT_EQ(result.verdict, MotionVerdict::free) << n;
    }
    if (result.verdict == MotionVerdict::free && gap > 1e-4) {
      ASSERT_FALSE(checkCertificate(edge, {&pair, 1}, options, 1, certificate, context)) << n;
      ++audited;
    }
    certificate.free = {{0, 0, 1, 1e-5 * size}};
    if (gap < 0) {
      ASSERT_TRUE(checkCertificate(edge, {&pair, 1}, options, 1, certificate, context)) << n;
    }
  }
  EXPECT_GT(known, 1'000);
  EXPECT_GT(audited, 100);
}

}  // namespace
}  // namespace corridor
