#pragma once

#include <vector>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/cost_model.h"
#include "planner/benchmark/statistics.h"

namespace corridor {

/// Returns the index of the reference variant: the first variant that solved anything, or else the
/// first variant. Times of all variants are given as multiples of the reference variant's times.
std::size_t referenceVariant(const std::vector<CampaignCell>& cells);

/// The results of a variant over all problems, planners and seeds of a campaign.
struct VariantScore {
  std::size_t variant = 0;  ///< index
  std::size_t runs = 0, failed = 0, solved = 0;
  std::size_t certified = 0, proved = 0, refuted = 0, undecided = 0;  ///< counts of solved runs
  Interval solvedShare;   ///< the share of runs that are solved
  Interval refutedShare;  ///< the share of verified paths that are refuted
  /// Processor time as a multiple of the reference variant's: the median and its interval, over
  /// pairs of runs of the same problem, planner and seed that both variants solved. NaN without
  /// pairs.
  std::size_t pairs = 0;
  double timeRatio = 0;
  Interval timeRatioInterval;
  /// The costs of a test, C_v and C_p: N_v·C_v + N_p·C_p is fitted, by least squares, to the time
  /// that the variant's runs spent in checking. The quantiles of measured over predicted time show
  /// how well this predicts a run. Each half of the runs is predicted with the costs of the other
  /// half; NaN for fewer than four runs. Unset for competitors, whose tests are not counted.
  struct Cost {
    CostModel model;
    double ratioP5 = 0, ratioMedian = 0, ratioP95 = 0;
  };
  std::optional<Cost> cost;
  /// Medians over the solved runs; NaN if there are none. `checkingShare`: the share of the run's
  /// time that was spent in checking. `lengthRatio`: the path's length after simplifying, divided
  /// by its length before.
  double checkingShare = 0, lengthRatio = 0;

  std::size_t judged() const { return proved + refuted + undecided; }
};

/// Returns the variants in order of rank: first those without a refuted path, the quickest first;
/// then the others by the share of paths refuted, then by time. Variants that solved nothing are
/// last.
std::vector<VariantScore> scoresOf(const Campaign& campaign,
                                   const std::vector<CampaignCell>& cells);

/// Returns the time that a run spent in checking, in nanoseconds, and the numbers of its tests;
/// nullopt if it has no time or no tests.
std::optional<QueryCost> checkingCost(const BenchmarkRun& run);

}  // namespace corridor
