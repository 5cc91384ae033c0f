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
  std::size_t provedPaths = 0;  ///< returned paths that the verifier proved
  std::size_t made = 0;         ///< trajectories that were made
  std::size_t proved = 0, refuted = 0, undecided = 0;
  std::size_t refutedOfProved = 0;  ///< refuted trajectories along proved paths
  /// Trajectories that are proved to keep the bounds and all limits. A limit whose share is unknown
  /// (−1 in TrajectoryRun) is left out.
  std::size_t withinLimits = 0;
  Interval refutedShare;  ///< of the trajectories that were made
  // Medians, in seconds. All numbers below are NaN if no trajectory was made.
  double duration = 0, makeTime = 0, verifyTime = 0;
  double rows = 0;  ///< median
  /// The median of the duration divided by `optimumAlong`.
  double overOptimum = 0;
  /// The share of the cost of stopping that a trajectory saves: (stop − T) / (stop − optimum). T is
  /// the duration of the trajectory, `stop` is the duration of the trajectory by the maker `stop`,
  /// and the optimum is `optimumAlong`. The value is the median over the paths for which the cost
  /// of stopping, stop − optimum, exceeds a thousandth of the optimum. NaN without the maker
  /// `stop`.
  double saved = 0;
  /// The largest share of each kind of limit that any of the trajectories uses. NaN: there is no
  /// such limit.
  double velocity = 0, acceleration = 0, jerk = 0, link = 0;
};

/// Returns the score of a set of limits and a maker over these runs. @param set,maker indices in
/// `CampaignTrajectories`.
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

/// Returns the prefix of the columns of a set and a maker: "spline_" if the set has no name, or
/// "published_spline_" for a set with the name "published".
std::string trajectoryPrefix(const CampaignTrajectories& trajectories, std::size_t set,
                             std::size_t maker);

}  // namespace corridor
