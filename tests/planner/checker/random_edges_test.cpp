// Random edges of real arms in real scenes. If the checker calls an edge free, the verifier must
// prove it, and no sample of the edge may be in contact. If the checker reports a contact, the edge
// must touch.
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/solve/verify_solution.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Random = std::mt19937_64;
constexpr int kSamples = 100;

/// Returns a random configuration within the bounds.
Configuration randomState(const Problem& problem, Random& random) {
  Configuration q(static_cast<Eigen::Index>(problem.model.space.size()));
  for (const Coordinate& c : problem.model.space.coordinates())
    q[static_cast<Eigen::Index>(c.first)] =
        std::uniform_real_distribution<double>(c.lower, c.upper)(random);
  return q;
}

Configuration step(const Configuration& from, double length, Random& random) {
  std::normal_distribution<double> normal;
  Configuration direction(from.size());
  for (double& d : direction) d = normal(random);
  return from + direction.normalized() * length;
}

struct Tally {
  int edges = 0, free = 0, contact = 0, undecided = 0, self = 0, unproved = 0;
};

void checkEdge(const Problem& problem, const Checker& checker, const Configuration& from,
               const Configuration& to, Tally& tally) {
  const MotionResult result = checker.certifyEdge(from, to);
  ++tally.edges;
  if (result.verdict == MotionVerdict::free) {
    ++tally.free;
    Solution solution;
    solution.path = {from, to};
    const PathReport report = verifySolution(problem, solution).pathReport;
    EXPECT_NE(report.verdict, PathVerdict::refuted)
        << report.findings[0].a << " meets " << report.findings[0].b << " at "
        << report.findings[0].t << " from " << from.transpose() << " to " << to.transpose();
    tally.unproved += report.verdict == PathVerdict::undecided;
    for (int i = 0; i <= kSamples; ++i)
      ASSERT_FALSE(
          checker.interference(problem.model.space.interpolate(from, to, double(i) / kSamples)));
  } else if (result.verdict == MotionVerdict::contact) {
    ++tally.contact;
    const auto moves = [&](std::size_t shape) {
      return problem.model.bodies[checker.bodyOf(shape)].frame != 0;
    };
    tally.self += moves(result.pair->bodyA) && moves(result.pair->bodyB);
    Solution solution;
    solution.path = {from, to};
    EXPECT_EQ(verifySolution(problem, solution).pathReport.verdict, PathVerdict::refuted)
        << "from " << from.transpose() << " to " << to.transpose();
  } else {
    ++tally.undecided;
  }
}

class RandomEdges : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Arms, RandomEdges, testing::Values("panda", "ur5"));

TEST_P(RandomEdges, FreeOnesAreProved) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  Random random(test::testSeed(6));
  const int perScene = test::casesOf(4, 200);
  Tally tally;
  for (const char* scene : {"bookshelf_thin", "box", "cage", "table_pick", "table_under_pick"}) {
    const int index = std::uniform_int_distribution(1, 50)(random);
    const Problem problem = readProblem((*data / "mbm" / GetParam() / scene).string() + ".json#" +
                                        std::to_string(index));
    SCOPED_TRACE(problem.source.name);
    const Checker checker(problem);
    for (int left = perScene; left > 0;) {
      // Half of the edges start where the problem's own paths do, close to obstacles.
      Configuration from = randomState(problem, random);
      if (left % 4 == 0) from = step(problem.task.start, 0.1, random);
      if (left % 4 == 2) from = step(problem.task.goals[0], 0.1, random);
      if (!checker.isProvedFree(from)) continue;
      const Configuration to =
          step(from, std::uniform_real_distribution<double>(0.1, 2)(random), random);
      if (!checker.inBounds(to)) continue;
      --left;
      checkEdge(problem, checker, from, to, tally);
    }
  }
  std::cout << tally.edges << " edges: " << tally.free << " free, " << tally.unproved
            << " of them not proved; " << tally.contact << " contacts, " << tally.self
            << " of links with each other; " << tally.undecided << " undecided\n";
  EXPECT_GT(tally.free, tally.edges / 10);
  EXPECT_GT(tally.contact, tally.edges / 10);
  EXPECT_LE(1000 * tally.undecided, tally.edges);
  EXPECT_LE(1000 * tally.unproved, tally.free);
}

}  // namespace
}  // namespace corridor
