#pragma once

#include <vector>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/statistics.h"

/// The trajectories of a campaign as columns and rows. planner/benchmark/README.md lists them.
namespace corridor {

/// The trajectories of one maker with one set of limits, along the paths of several runs.
struct TrajectoryScore {
  std::size_t paths = 0;        ///< returned paths
  std::size_t provedPaths = 0;  ///< those that the verifier proved
  std::size_t made = 0;         ///< trajectories
  std::size_t proved = 0, refuted = 0, undecided = 0;
  std::size_t refutedOfProved = 0;  ///< refuted trajectories along proved paths
  std::size_t withinLimits = 0;     ///< trajectories that are proved to keep all limits
  Interval refutedShare;            ///< of the trajectories that were made
  // Medians, in seconds. NaN without trajectories, as all numbers below.
  double duration = 0, makeTime = 0, verifyTime = 0;
  double rows = 0;  ///< median
  /// Duration divided by `optimumAlong`: the median.
  double overOptimum = 0;
  /// The share of the cost of stopping that the trajectory saves, (stop − T) / (stop − optimum),
  /// where T is its duration, `stop` that of the maker `stop`, and the optimum is `optimumAlong`.
  /// The median over the paths on which stopping costs more than a thousandth of the optimum. NaN
  /// without the maker `stop`.
  double saved = 0;
  /// The largest shares of limits of all trajectories; NaN: no such limit.
  double velocity = 0, acceleration = 0, jerk = 0, link = 0;
};

/// @param set, maker indices in `CampaignTrajectories`.
TrajectoryScore scoreOf(const CampaignTrajectories& trajectories,
                        const std::vector<const BenchmarkRun*>& runs, std::size_t set,
                        std::size_t maker);
/// Returns the score of a variant over all problems, planners and seeds.
TrajectoryScore scoreOf(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                        std::size_t variant, std::size_t set, std::size_t maker);

/// Appends the columns of a run's trajectories; none if the campaign makes no trajectories.
void addTrajectories(const Campaign& campaign, const BenchmarkRun& run, Row& row);
/// Appends the columns of the trajectories of all runs of a cell.
void addTrajectories(const Campaign& campaign, const CampaignCell& cell, Row& row);

/// Returns one row per variant, set of limits and maker, over all problems, planners and seeds.
std::vector<Row> trajectoryRows(const Campaign& campaign, const std::vector<CampaignCell>& cells);

/// Returns the prefix of the columns of a set and a maker: "spline_", "published_spline_".
std::string trajectoryPrefix(const CampaignTrajectories& trajectories, std::size_t set,
                             std::size_t maker);

}  // namespace corridor
