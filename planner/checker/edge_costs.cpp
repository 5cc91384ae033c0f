#include "planner/checker/edge_costs.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "collision/core/quantiles.h"
#include "planner/robot/edge_motion.h"

namespace corridor {
namespace {

/// An edge ends at this fraction of the way to a random state.
constexpr double kShareOfTheWay = 0.2;

double secondsOf(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Configuration randomState(const ConfigurationSpace& space, std::mt19937_64& random) {
  Configuration q(static_cast<Eigen::Index>(space.size()));
  std::normal_distribution<double> normal;
  for (const Coordinate& c : space.coordinates()) {
    const auto first = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::rotation)
      for (Eigen::Index i = 0; i < 4; ++i) q[first + i] = normal(random);
    else if (c.kind == Coordinate::Kind::circle)
      q[first] = std::uniform_real_distribution(-std::numbers::pi, std::numbers::pi)(random);
    else
      q[first] = std::uniform_real_distribution(c.lower, c.upper)(random);
  }
  space.normalise(q);
  return q;
}

}  // namespace

EdgeCosts sampleEdgeCosts(const Checker& checker, std::size_t edges, double seconds,
                          std::uint64_t seed) {
  const Scene& scene = checker.scene();
  const ConfigurationSpace& space = checker.space();
  EdgeMotion motion(checker.model().tree, space, scene.framePairs(), checker.tube());
  QueryContext context;
  std::mt19937_64 random(seed);
  EdgeCosts costs;
  std::vector<double> free, other;
  std::map<std::pair<std::size_t, std::size_t>, EdgeCosts::OfPair> pairs;
  double all = 0;
  std::vector<std::pair<Configuration, Configuration>> ways;
  const auto start = std::chrono::steady_clock::now();
  // Returns whether more than the fraction `share` of `seconds` has passed.
  const auto past = [&](double share) {
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    return took.count() > share * seconds;
  };
  for (std::size_t i = 0; i < edges && (i == 0 || !past(0.25)); ++i) {
    const Configuration from = randomState(space, random);
    ways.emplace_back(from, space.interpolate(from, randomState(space, random), kShareOfTheWay));
    // The first query that needs a tree builds the tree. The time to build trees must not count for
    // an edge, so each edge is certified once before the measurement.
    motion.set(from, ways.back().second);
    scene.certify(motion, checker.options(), context);
  }
  for (const auto& [from, to] : ways) {
    if (costs.edges > 0 && past(1)) break;
    ++costs.edges;
    motion.set(from, to);
    MotionResult result;
    const double took =
        secondsOf([&] { result = scene.certify(motion, checker.options(), context); });
    (result.verdict == MotionVerdict::free ? free : other).push_back(took);
    for (std::size_t k = 0; k < scene.motionPairs().size(); ++k) {
      const MotionPair& pair = scene.motionPairs()[k];
      MotionOptions options = checker.options();
      options.margin = options.marginOf(k);  // margins of pairs belong to the query of all pairs
      options.pairMargins = nullptr;
      Counters before;
      const auto queryAlone = [&] {
        before = context.counters;
        return secondsOf([&] { certifyMotion(motion, {&pair, 1}, options, context); });
      };
      const auto treesBuilt = [&] {
        return scene.bodies()[pair.bodyA].body.treeBuilt() +
               scene.bodies()[pair.bodyB].body.treeBuilt();
      };
      const int trees = treesBuilt();
      double alone = queryAlone();
      // The queries of the whole edges end at the first contact, so they may leave a tree unbuilt.
      // If the query of this pair built a tree, the query is measured again.
      if (treesBuilt() != trees) alone = queryAlone();
      std::size_t a = checker.bodyOf(pair.bodyA), b = checker.bodyOf(pair.bodyB);
      if (b < a) std::swap(a, b);
      EdgeCosts::OfPair& of = pairs[{a, b}];
      of.a = a, of.b = b, of.share += alone, all += alone;
      of.boxTests += context.counters.boxTests - before.boxTests;
      of.primitiveTests += context.counters.primitiveTests - before.primitiveTests;
    }
  }
  costs.free = free.size();
  if (!free.empty()) costs.freeSeconds = medianOf(free);
  if (!other.empty()) costs.otherSeconds = medianOf(other);
  for (auto& [bodies, of] : pairs) {
    of.share = all > 0 ? of.share / all : 0;
    costs.pairs.push_back(of);
  }
  std::stable_sort(costs.pairs.begin(), costs.pairs.end(),
                   [](const auto& a, const auto& b) { return a.share > b.share; });
  return costs;
}

}  // namespace corridor
