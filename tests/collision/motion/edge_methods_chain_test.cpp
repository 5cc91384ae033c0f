// Compares all methods that prove motions with static samples, on random kinematic chains.
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "collision/motion/edge_method.h"
#include "collision/queries/interference.h"
#include "tests/collision/motion/bodies.h"
#include "tests/collision/motion/grazing.h"
#include "tests/support/chain_motion.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::blob;
using test::bodyOf;
using test::ChainMotion;
using test::Proof;

class EdgeMethodsOfChains : public testing::TestWithParam<Proof> {};

INSTANTIATE_TEST_SUITE_P(All, EdgeMethodsOfChains, test::everyProof(), test::proofName);

/// The motions are those of kinematic chains: the relative motions come from the motion source
/// `ChainMotion` instead of `RigidEdge`.
TEST_P(EdgeMethodsOfChains, RandomChainsAgainstSamples) {
  std::mt19937_64 random(test::testSeed(24));
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&] { return Vec3(real(), real(), real()); };
  MotionOptions options;
  options.tolerance = 1e-7;
  QueryContext context;
  std::array<int, 3> verdicts = {};
  const int count = test::isStressRun() ? 2'000 : 150;
  for (int n = 0; n < count; ++n) {
    const Body a = bodyOf(blob(random, 40, 3, 0.4)), b = bodyOf(blob(random, 40, 0.4, 0.3));
    std::vector<ChainMotion::Joint> joints;
    for (int j = 0; j < 1 + n % 5; ++j) {
      const double from = real(-3, 3), length = std::pow(10.0, real(-2, 0));
      joints.push_back({real() > 0.5, vector(), 2 * vector(), from, from + length * real()});
    }
    ChainMotion motion(joints);
    const MotionPair pair{&a, &b};
    options.earliest = n % 2;
    const MotionResult r = GetParam()(motion, {&pair, 1}, options, context);
    ++verdicts.at(static_cast<std::size_t>(r.verdict));
    const auto touches = [&](double t) {
      const auto X = motion.pose(t);
      const Transform X_AB{X.R.cast<double>(), X.t.cast<double>()};
      return interference(Posed(a.binaryTree()), Posed(b.binaryTree(), X_AB), context).has_value();
    };
    if (r.verdict == MotionVerdict::contact) {
      ASSERT_TRUE(touches(r.time)) << n;
    }
    for (int i = 0; i <= 100 && r.certifiedUntil > 0; ++i)
      ASSERT_FALSE(touches(r.certifiedUntil * i / 100)) << n << " at " << i;
  }
  std::cout << verdicts[0] << " free, " << verdicts[1] << " contact, " << verdicts[2]
            << " undecided\n";
  EXPECT_GT(verdicts[0], count / 10);
  EXPECT_GT(verdicts[1], count / 20);
  EXPECT_LE(verdicts[2], 1 + count / 100'000);
}

}  // namespace
}  // namespace corridor
