// The grids of pairs of links, for joints of all kinds: what a grid proves is true at samples.
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "collision/core/circle.h"
#include "collision/core/error.h"
#include "collision/core/file_cache.h"
#include "planner/checker/checker.h"
#include "planner/checker/pair_grids.h"
#include "planner/problem/problem.h"
#include "tests/planner/checker/cube_file.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

std::string vectorText(Random& random, double size) {
  std::ostringstream text;
  text.precision(17);
  for (int k = 0; k < 3; ++k) text << uniform(random, -size, size) << ' ';
  return text.str();
}

std::string linkText(Random& random, const std::string& name) {
  std::ostringstream text;
  text << "<link name='" << name << "'><collision><origin xyz='" << vectorText(random, 0.2)
       << "' rpy='" << vectorText(random, 1) << "'/><geometry><mesh filename='cube.obj' scale='";
  for (int k = 0; k < 3; ++k) text << uniform(random, 0.02, 0.2) << ' ';
  text << "'/></geometry></collision></link>\n";
  return text.str();
}

/// Joints of a chain: prismatic, continuous, or revolute with limits within or beyond a turn; the
/// later ones may mimic the first, also with multipliers that are not whole.
class RandomChain {
 public:
  explicit RandomChain(Random& random) : random_(random) {
    const std::size_t joints = 2 + random() % 2;
    urdf_ = "<robot name='chain'>\n" + linkText(random, "l0");
    for (std::size_t j = 0; j < joints; ++j) {
      const std::string name = "l" + std::to_string(j + 1);
      // With three joints, the middle of the chain has a link without a body.
      urdf_ += j == 0 && joints == 3 ? "<link name='" + name + "'/>\n" : linkText(random, name);
      addJoint(j);
    }
    urdf_ += "</robot>\n";
  }

  Problem problemIn(const std::filesystem::path& folder) const {
    std::ofstream(folder / "arm.urdf") << urdf_;
    std::ofstream(folder / "problem.yaml")
        << "format: corridor-problem-1\nrobot: arm.urdf\nworld: {post: {sphere: 0.1, at: [9, 9, "
           "9]}}\nstart: {"
        << middle_ << "}\ngoal: {" << middle_ << "}\n";
    return readProblem(folder / "problem.yaml");
  }

 private:
  void addJoint(std::size_t j) {
    const auto kind = random_() % 5;
    const bool isMimic = j > 0 && random_() % 3 == 0;
    std::ostringstream text;
    text.precision(17);
    text << "<joint name='j" << j << "' type='"
         << (kind == 0   ? "prismatic"
             : kind == 1 ? "continuous"
                         : "revolute")
         << "'><origin xyz='" << vectorText(random_, 0.25) << "' rpy='" << vectorText(random_, 1)
         << "'/><axis xyz='" << vectorText(random_, 1) << "'/>";
    double middle = 0;
    if (kind != 1) {
      const std::array<double, 5> least{0.05, 0, 0.3, 2, 6.4}, most{0.6, 0, 3, 6, 14};
      const double width = uniform(random_, least[kind], most[kind]);
      middle = uniform(random_, kind == 0 ? -0.2 : -4, kind == 0 ? 0.2 : 4);
      text << "<limit lower='" << middle - width / 2 << "' upper='" << middle + width / 2
           << "' effort='1' velocity='1'/>";
    }
    if (isMimic) {
      const std::array<const char*, 5> multipliers{"1", "-1", "2", "0.5", "-0.37"};
      text << "<mimic joint='j0' multiplier='" << multipliers[random_() % 5] << "' offset='"
           << (random_() % 2 ? 0.3 : 0.0) << "'/>";
    } else {
      middle_ +=
          (middle_.empty() ? "j" : ", j") + std::to_string(j) + ": " + std::to_string(middle);
    }
    text << "<parent link='l" << j << "'/><child link='l" << j + 1 << "'/></joint>\n";
    urdf_ += text.str();
  }

  Random& random_;
  std::string urdf_, middle_;
};

Configuration stateOf(const ConfigurationSpace& space, Random& random) {
  Configuration q(static_cast<Eigen::Index>(space.size()));
  for (const Coordinate& c : space.coordinates()) {
    const bool isLimited = c.kind == Coordinate::Kind::line && std::isfinite(c.upper - c.lower);
    const double most = random() % 4 == 0 ? 50 : 3.3;  // several turns
    double& number = q[static_cast<Eigen::Index>(c.first)];
    if (!isLimited) {
      number = uniform(random, -most, most);
      continue;
    }
    const double width = c.upper - c.lower;
    switch (random() % 10) {
      case 0:
        number = c.upper;
        break;
      case 1:  // a grid ends at the limits
        number = uniform(random, c.lower - width, c.upper + width);
        break;
      default:
        number = uniform(random, c.lower, c.upper);
    }
  }
  return q;
}

Configuration between(const ConfigurationSpace& space, const Configuration& a,
                      const Configuration& b, double t) {
  Configuration q = a;
  for (const Coordinate& c : space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    q[i] += t * (c.kind == Coordinate::Kind::circle ? circleTurn(a[i], b[i]).angle : b[i] - a[i]);
  }
  return q;
}

TEST(PairGridsOfJoints, ProveOnlyWhatIsTrue) {
  Random random(test::testSeed(95));
  const std::filesystem::path folder = test::newFolder();
  test::writeCube(folder);
  int robots = 0, proofs = 0;
  for (int n = 0; n < test::casesOf(60, 3000); ++n) {
    std::optional<Problem> read;
    try {
      read = RandomChain(random).problemIn(folder);
    } catch (const InputError&) {  // not every joint may mimic every other one
      continue;
    }
    Problem& problem = *read;
    problem.model.cache = std::make_shared<FileCache>(folder / "cache", "code");
    const Checker checker(problem);
    PairGrids::compute(problem.model, checker.scene());
    problem.model.cache->save();
    const PairGrids grids(problem.model, checker.scene(), checker.tube());
    problem.model.cache->clear();
    if (grids.empty()) continue;
    ++robots;
    const ConfigurationSpace& space = problem.model.space;
    const PairMargins search(std::vector(checker.scene().pairs().size(), 0.0051));
    std::vector<std::uint8_t> proved;
    for (int e = 0; e < 100; ++e) {
      const Configuration from = stateOf(space, random), other = stateOf(space, random);
      const double part = std::array{0.0, 0.02, 0.2, 1.0}[static_cast<std::size_t>(e % 4)];
      const Configuration to = from + part * (other - from);
      if (space.ambiguous(from, to)) continue;
      MotionOptions options = checker.options();
      options.margin = std::array{0.0049, 0.0, 1e-5}[static_cast<std::size_t>(e % 3)];
      grids.prove(from, to, options, proved);
      std::vector<std::uint32_t> pairs;
      for (std::uint32_t k = 0; k < proved.size(); ++k)
        if (proved[k]) pairs.push_back(k);
      if (pairs.empty()) continue;
      ++proofs;
      const int samples = part == 0 ? 0 : 20;
      for (int i = 0; i <= samples; ++i)
        for (const Scene::NearPair& near : checker.pairsWithin(
                 between(space, from, to, samples ? double(i) / samples : 0), search, {&pairs, 1}))
          EXPECT_GT(near.distance.distance, options.margin) << "robot " << n << ", edge " << e;
    }
  }
  std::filesystem::remove_all(folder);
  EXPECT_GT(robots, 30);
  EXPECT_GT(proofs, 1000);
}

}  // namespace
}  // namespace corridor
