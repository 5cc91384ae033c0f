#include "planner/benchmark/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "collision/core/quantiles.h"

namespace corridor {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Returns the path's length after simplifying, divided by its length before. Both lengths are in
/// metres, or in radians if the path has no length in metres.
double lengthRatio(const BenchmarkRun& run) {
  return run.rawLength.metres > 0    ? run.length.metres / run.rawLength.metres
         : run.rawLength.radians > 0 ? run.length.radians / run.rawLength.radians
                                     : kNone;
}

/// Fits the costs of tests. The ratios of measured to predicted time are for runs that were not
/// fitted: each half of the runs is predicted with the costs of the other half. With fewer than
/// four runs the ratios are NaN.
VariantScore::Cost costOf(const std::vector<QueryCost>& queries) {
  VariantScore::Cost cost{fittedCosts(queries), kNone, kNone, kNone};
  if (queries.size() < 4) return cost;
  std::vector<QueryCost> halves[2];
  for (std::size_t i = 0; i < queries.size(); ++i) halves[i % 2].push_back(queries[i]);
  std::vector<double> ratios;
  for (const int half : {0, 1}) {
    const CostModel model = fittedCosts(halves[1 - half]);
    for (const QueryCost& query : halves[half])
      if (const double predicted = model.predicted(query); predicted > 0)
        ratios.push_back(query.ns / predicted);
  }
  if (ratios.empty()) return cost;
  cost.ratioP5 = quantileOf(ratios, 0.05);
  cost.ratioMedian = medianOf(ratios);
  cost.ratioP95 = quantileOf(ratios, 0.95);
  return cost;
}

/// For each run, appends its processor time divided by that of the reference variant's run with the
/// same seed, if both runs are solved.
void addRatios(const CampaignCell& cell, const CampaignCell& reference,
               std::vector<double>& ratios) {
  auto other = reference.runs.begin();  // both are ordered by seed
  for (const BenchmarkRun& run : cell.runs) {
    while (other != reference.runs.end() && other->seed < run.seed) ++other;
    if (other == reference.runs.end()) break;
    if (run.seed == other->seed && run.solved && other->solved && other->processorTime > 0)
      ratios.push_back(run.processorTime / other->processorTime);
  }
}

}  // namespace

std::size_t referenceVariant(const std::vector<CampaignCell>& cells) {
  std::optional<std::size_t> first;
  for (const CampaignCell& cell : cells)
    if (std::any_of(cell.runs.begin(), cell.runs.end(), [](const auto& run) { return run.solved; }))
      first = std::min(first.value_or(cell.variant), cell.variant);
  return first.value_or(0);
}

std::optional<QueryCost> checkingCost(const BenchmarkRun& run) {
  const QueryCost cost{static_cast<double>(run.counters.boxTests),
                       static_cast<double>(run.counters.primitiveTests), 1e9 * run.checkingTime};
  if (!(cost.ns > 0) || cost.boxTests + cost.primitiveTests == 0) return std::nullopt;
  return cost;
}

std::vector<VariantScore> scoresOf(const Campaign& campaign,
                                   const std::vector<CampaignCell>& cells) {
  const std::size_t reference = referenceVariant(cells);
  std::vector<VariantScore> scores;
  for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
    VariantScore score;
    score.variant = v;
    std::vector<double> ratios, shares, lengths;
    std::vector<QueryCost> costs;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const CampaignCell& cell = cells[c];
      if (cell.variant != v) continue;
      // cellsOf puts the variants of a problem and planner next to each other.
      addRatios(cell, cells[c - v + reference], ratios);
      for (const BenchmarkRun& run : cell.runs) {
        ++score.runs;
        score.failed += run.result == "failed";
        score.solved += run.solved;
        score.certified += run.certified;
        score.proved += run.verdict == "proved";
        score.refuted += run.verdict == "refuted";
        score.undecided += run.verdict == "undecided";
        if (const auto cost = checkingCost(run); cost && !campaign.variants[v].competitor)
          costs.push_back(*cost);
        if (!run.solved) continue;
        shares.push_back(run.checkingTime / run.time);
        if (const double share = lengthRatio(run); !std::isnan(share)) lengths.push_back(share);
      }
    }
    score.solvedShare = shareInterval(score.solved, score.runs);
    score.refutedShare = shareInterval(score.refuted, score.judged());
    score.pairs = ratios.size();
    score.timeRatio = medianOf(ratios);
    score.timeRatioInterval = medianInterval(ratios);
    if (!costs.empty()) score.cost = costOf(costs);
    score.checkingShare = medianOf(shares);
    score.lengthRatio = medianOf(lengths);
    scores.push_back(score);
  }
  const auto rank = [](const VariantScore& s) {
    const double share =
        s.judged() > 0 ? static_cast<double>(s.refuted) / static_cast<double>(s.judged()) : 0;
    return std::tuple(s.solved == 0, share, std::isnan(s.timeRatio) ? HUGE_VAL : s.timeRatio);
  };
  std::stable_sort(scores.begin(), scores.end(),
                   [&](const VariantScore& a, const VariantScore& b) { return rank(a) < rank(b); });
  return scores;
}

}  // namespace corridor
