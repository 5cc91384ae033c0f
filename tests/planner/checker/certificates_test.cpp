// `checkCertificate` accepts the certificates of nearly all free edges, at the default clearance
// slack and tube.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "collision/motion/check_certificate.h"
#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/robot/edge_motion.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

class Certificates : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Own, Certificates,
                         testing::Values("cubicles", "arm_at_shelf", "two_arms", "rover_door",
                                         "snake_posts"),
                         [](const auto& given) { return std::string(given.param); });

Configuration randomState(const ConfigurationSpace& space, std::mt19937_64& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  Configuration q(static_cast<Eigen::Index>(space.size()));
  for (const Coordinate& c : space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::line)
      q[i] = std::uniform_real_distribution(c.lower, c.upper)(random);
    else
      for (Eigen::Index k = 0; k < static_cast<Eigen::Index>(c.size()); ++k)
        q[i + k] = 3 * real(random);
  }
  space.normalise(q);
  return q;
}

TEST_P(Certificates, AreAccepted) {
  const Problem problem =
      readProblem(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems" / GetParam());
  const Checker checker(problem);
  const Scene& scene = checker.scene();
  EdgeMotion motion(problem.model.tree, problem.model.space, scene.framePairs(), problem.task.tube);
  QueryContext context;
  std::mt19937_64 random(test::testSeed(11));
  const int wanted = test::isStressRun() ? 1'000 : 60;
  int free = 0, accepted = 0;
  for (int n = 0; n < 100 * wanted && free < wanted; ++n) {
    const Configuration from = randomState(problem.model.space, random);
    if (!checker.isProvedFree(from)) continue;
    // 1 to 20 % of the way to another state.
    const double share = std::pow(10.0, std::uniform_real_distribution(-2.0, -0.7)(random));
    const Configuration to =
        problem.model.space.interpolate(from, randomState(problem.model.space, random), share);
    motion.set(from, to);
    MotionCertificate certificate;
    MotionOptions options = checker.options();
    if (scene.certify(motion, options, context, certificate).verdict != MotionVerdict::free)
      continue;
    ++free;
    accepted += !checkCertificate(motion, scene.motionPairs(), options, 1, certificate, context);
  }
  EXPECT_GE(free, wanted / 2);
  EXPECT_GE(accepted, 0.99 * free) << "of " << free;
}

}  // namespace
}  // namespace corridor
