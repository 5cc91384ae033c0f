#pragma once

#include <vector>

#include "collision/course/cost_model.h"
#include "planner/benchmark/campaign.h"
#include "planner/benchmark/statistics.h"

namespace corridor {

/// Returns the index of the reference variant: the first variant with a solved run, or, if no run
/// is solved, the first variant. Times of all variants are given as multiples of the reference
/// variant's times.
std::size_t referenceVariant(const std::vector<CampaignCell>& cells);

/// The results of a variant over all problems, planners and seeds of a campaign.
struct VariantScore {
  std::size_t variant = 0;  ///< index
  std::size_t runs = 0, failed = 0, solved = 0;
  std::size_t certified = 0, proved = 0, refuted = 0, undecided = 0;  ///< counts of solved runs
  Interval solvedShare;   ///< of the share of runs that are solved
  Interval refutedShare;  ///< of the share of verified paths that are refuted
  /// Processor time as a multiple of the reference variant's processor time. A pair is a run of
  /// this variant and the run of the reference variant for the same problem, planner and seed, if
  /// both are solved. `pairs` is the number of pairs. `timeRatio` is the median over all pairs,
  /// with its confidence interval. Without pairs the median is NaN; with fewer than six pairs the
  /// interval is infinite.
  std::size_t pairs = 0;
  double timeRatio = 0;
  Interval timeRatioInterval;
  /// The costs of a test, C_v and C_p: N_v·C_v + N_p·C_p is fitted, by least squares, to the times
  /// that the variant's runs spent in checking. The quantiles of the ratio of measured to predicted
  /// time show how well the fit predicts a run. Each half of the runs is predicted with the costs
  /// of the other half; NaN for fewer than four runs. Unset for competitors, whose tests are not
  /// counted, and for variants without a counted test.
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

/// Returns the scores of the variants in order of rank: by the share of verified paths that are
/// refuted (0 if no path was verified), and for equal shares by `timeRatio`, the quickest first.
/// Variants without a solved run are last.
std::vector<VariantScore> scoresOf(const Campaign& campaign,
                                   const std::vector<CampaignCell>& cells);

/// Returns the time that a run spent in checking, in nanoseconds, and the numbers of the run's
/// tests. Returns nullopt if this time is 0, or there were no tests.
std::optional<QueryCost> checkingCost(const BenchmarkRun& run);

}  // namespace corridor
