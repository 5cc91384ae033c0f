#pragma once

#include <atomic>
#include <functional>

#include "planner/benchmark/campaign.h"
#include "planner/jobs/executor.h"

namespace corridor {

struct CampaignProgress {
  std::uint64_t done = 0, total = 0;  ///< runs, including those of earlier sessions
  double secondsLeft = 0;             ///< an estimate; negative: not known yet
  const CampaignCell& cell;           ///< the cell of the run that begins now
  std::uint64_t seed;
};

struct CampaignOptions {
  std::function<void(const CampaignProgress&)> progress;
  /// Called with each finished run and the index of its cell. It may change the run before the run
  /// becomes a part of the result (`RunTrimmer`). If it throws, the campaign ends.
  std::function<void(std::size_t cell, BenchmarkRun&)> done;
  /// The executor that makes the runs; each run is a task that `runStarter` starts. Null: the runs
  /// are child processes of this process, `jobs` at a time. If several runs are made at a time, the
  /// measured times are those of a busy machine.
  Executor* executor = nullptr;
  std::size_t jobs = 1;
  /// When it becomes true, unfinished runs are killed, and the result has only the finished runs.
  const std::atomic<bool>* interrupted = nullptr;
};

/// Returns the function with which executors start the runs of a campaign. @pre the campaign
/// outlives the result.
TaskStarter runStarter(const Campaign& campaign);

/// Makes the runs that are missing in the cells, each in a process of its own. The variants take
/// turns seed by seed, so that other work on the machine affects all variants alike.
/// @param cells the cells that `cellsOf` returns, with the runs of earlier sessions. @pre
/// `checkCampaign` has not thrown for this campaign; the process has only one thread.
CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options,
                           std::vector<CampaignCell> cells);
CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options = {});

}  // namespace corridor
