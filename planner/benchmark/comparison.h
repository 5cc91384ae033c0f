#pragma once

#include <vector>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/cost_model.h"
#include "planner/benchmark/statistics.h"

namespace corridor {

/// The variant in whose time that of the others is told: the first that solved anything, else the
/// first.
std::size_t referenceVariant(const std::vector<CampaignCell>& cells);

/// How a variant did over all problems, planners and seeds of a campaign.
struct VariantScore {
  std::size_t variant = 0;  ///< index
  std::size_t runs = 0, failed = 0, solved = 0;
  std::size_t certified = 0, proved = 0, refuted = 0, undecided = 0;  ///< of those solved
  Interval solvedShare;                                               ///< of the runs
  Interval refutedShare;  ///< of the paths that were judged: proved, refuted, undecided
  /// Processor time as a multiple of the reference variant's, in pairs of runs of one problem,
  /// planner and seed that both solved: the median, and how sure it is. NaN without pairs.
  std::size_t pairs = 0;
  double timeRatio = 0;
  Interval timeRatioInterval;
  /// What a test costs within its runs, by least squares of N_v·C_v + N_p·C_p against the time that
  /// went into checking; how well that tells a run's: quantiles of measured over predicted, each
  /// half of the runs by the costs of the other (NaN of fewer than four). None of peers, which
  /// count nothing.
  struct Cost {
    CostModel model;
    double ratioP5 = 0, ratioMedian = 0, ratioP95 = 0;
  };
  std::optional<Cost> cost;
  /// The share of the time that went into checking, and of the planner's path length that was left
  /// after simplifying: medians over the runs that were solved; NaN of none.
  double checkingShare = 0, lengthShare = 0;

  std::size_t judged() const { return proved + refuted + undecided; }
};

/// Ranked: variants of which no path was refuted, the quickest first; then the others, by the share
/// of paths refuted, and then by time.
std::vector<VariantScore> scoresOf(const Campaign& campaign,
                                   const std::vector<CampaignCell>& cells);

/// The time of a run that went into checking, nanoseconds, and its tests; nothing where it has none
/// of either.
std::optional<QueryCost> checkingCost(const BenchmarkRun& run);

}  // namespace corridor
