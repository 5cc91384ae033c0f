// A problem's checker gives the same answers with the trees of every volume, and refuses names of
// volume, fit and overlap test that can't be combined.
#include <map>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Rigid;

/// Returns every volume with each of its overlap tests; the fit and the way of building are the
/// last of those that the volume has.
std::vector<TreeNames> everyVolume() {
  std::vector<TreeNames> all;
  for (const VolumeKind& kind : volumeKinds())
    for (const std::string& overlap : kind.overlaps)
      all.push_back({kind.name, kind.fits.back(), overlap, kind.builds.back()});
  return all;
}

Problem with(Problem problem, const TreeNames& words) {
  problem.settings.checker.trees.volume = words.volume;
  problem.settings.checker.trees.fit = words.fit;
  problem.settings.checker.trees.overlap = words.overlap;
  problem.settings.checker.trees.build = words.build;
  return problem;
}

/// Compares states and edges of meshes, and of primitives on a chain, by certified and by exact
/// tests.
TEST(CheckerVolumes, AgreeOnStatesAndEdges) {
  std::mt19937_64 random(test::testSeed(71));
  const auto real = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const int count = (test::isStressRun() ? 2'000 : 150) / test::kSlowdown;
  for (const Problem& problem : {test::hallProblem(Rigid::SE3), test::armProblem()}) {
    const bool rigid = problem.model.space.size() == 7;
    const auto anywhere = [&] {
      if (rigid) return test::poseOf(Rigid::SE3, real(-1, 1), real(-3, 3), real(-3, 3));
      return Configuration(Vec3(real(-3, 3), real(-2.5, 2.5), real(-2.5, 2.5)));
    };
    std::vector<Configuration> from, to;
    for (int n = 0; n < count; ++n) {
      from.push_back(anywhere());
      to.push_back(rigid || n % 2 ? anywhere() : Configuration(0.9 * from.back()));
    }
    std::vector<int> usual;
    std::map<std::uint64_t, int> tests;
    for (const TreeNames& words : everyVolume()) {
      SCOPED_TRACE(problem.source.name + ", " + words.volume + ", " + words.overlap);
      const Problem asked = with(problem, words);
      const Checker checker(asked);
      std::vector<int> verdicts;
      for (std::size_t n = 0; n < from.size(); ++n) {
        verdicts.push_back(static_cast<int>(checker.certifyState(from[n]).verdict));
        verdicts.push_back(checker.interference(from[n]).has_value());
        verdicts.push_back(checker.clearance(from[n]) > 0);
        verdicts.push_back(static_cast<int>(
            checker.certifyEdge(from[n], to[n], {.earliest = n % 2 == 1}).verdict));
        verdicts.push_back(checker.isProvedFree(from[n], to[n]));
      }
      if (usual.empty()) usual = verdicts;
      EXPECT_EQ(verdicts, usual);
      EXPECT_EQ(checker.counters().undecided, 0u);
      ++tests[checker.counters().boxTests];
    }
    EXPECT_GT(std::count(usual.begin(), usual.end(), 1), count / 4);
    EXPECT_GT(std::count(usual.begin(), usual.end(), 0), count / 4);
    EXPECT_GT(tests.size(), 6u) << "each must walk trees of its own kind";
  }
}

TEST(CheckerVolumes, WrongWordsThrow) {
  const auto message = [](const TreeNames& words, const std::string& edges) -> std::string {
    Problem problem = with(test::hallProblem(Rigid::SE2), words);
    problem.settings.checker.edges = edgeMethodNamed(edges).value();
    try {
      const Checker checker(problem);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({"rss", "hull", "rectangles"}, "certified"), "");
  EXPECT_NE(message({"cone", "", ""}, "certified"), "");
  EXPECT_NE(message({"rss", "", "gjk"}, "discrete"), "");
  EXPECT_EQ(message({"rss", "", "", "bottom-up"}, "certified"), "");
  EXPECT_NE(message({"obb", "", "", "bottom-up"}, "certified"), "");
  EXPECT_EQ(message({"obb-binary", "", "gjk"}, "discrete"), "");
  EXPECT_EQ(message({"obb-binary", "", "sat"}, "adaptive"), "");
  EXPECT_EQ(message({"obb-binary", "", "gjk"}, "advancement"),
            "checker.overlap: \"gjk\" can't be used with edges: advancement, which measures "
            "distances between volumes; leave overlap out, or use edges: certified");
}

}  // namespace
}  // namespace corridor
