#include "planner/checker/pair_survey.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

namespace corridor {

Configuration randomConfiguration(const ConfigurationSpace& space,
                                  const std::function<std::uint64_t()>& next) {
  Configuration q = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
  for (const Coordinate& c : space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::rotation) {
      q[i + 3] = 1;
      continue;
    }
    // 53 random bits make a double in [0, 1).
    const double share = static_cast<double>(next() >> 11) * 0x1p-53;
    const bool circle = c.kind == Coordinate::Kind::circle;
    const double lower = circle ? -std::numbers::pi : c.lower,
                 upper = circle ? std::numbers::pi : c.upper;
    // `min` keeps the value at most `upper`, even if the product is rounded up.
    if (std::isfinite(upper - lower)) q[i] = std::min(lower + share * (upper - lower), upper);
  }
  return q;
}

std::vector<SurveyedPair> surveyPairs(
    const Checker& checker, const PairSurveyOptions& options,
    const std::function<bool(std::size_t, std::size_t)>& wantsProof) {
  const Model& model = checker.model();
  std::vector<SurveyedPair> pairs;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> indexOf;
  forEachTestedPair(model, [&](std::size_t a, std::size_t b) {
    indexOf[{a, b}] = pairs.size();
    pairs.push_back({a, b, 0, movesFreely(model, a, b), std::nullopt});
  });
  std::mt19937_64 random(options.seed);
  for (std::size_t i = 0; i < options.samples; ++i) {
    const Configuration q = randomConfiguration(model.space, [&] { return random(); });
    for (const Checker::PairNotFree& pair : checker.pairsNotFree(q))
      ++pairs[indexOf.at({pair.a, pair.b})].contacts;
  }
  const NeverInContact prover(model, checker.scene());
  QueryContext context;
  for (SurveyedPair& pair : pairs)
    if (pair.contacts == 0 && !pair.movesFreely && wantsProof(pair.a, pair.b))
      pair.proof = prover.prove(pair.a, pair.b, options.proof, context);
  return pairs;
}

}  // namespace corridor
