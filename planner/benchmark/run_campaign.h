#pragma once

#include <atomic>
#include <functional>

#include "planner/benchmark/campaign.h"

namespace corridor {

struct CampaignProgress {
  std::uint64_t done = 0, total = 0;  ///< runs, those of earlier sessions included
  double secondsLeft = 0;             ///< an estimate; negative: none yet
  const CampaignCell& cell;           ///< of the run that begins
  std::uint64_t seed;
};

struct CampaignOptions {
  std::function<void(const CampaignProgress&)> progress;
  /// Called with each run that is done, by cell. @throws what ends the campaign.
  std::function<void(std::size_t cell, const BenchmarkRun&)> done;
  std::size_t jobs = 1;  ///< runs at a time; their times are those of a busy machine
  /// Where it becomes true, the runs under way are given up, and the result is what there is.
  const std::atomic<bool>* interrupted = nullptr;
};

/// Runs what the cells don't have yet, each run in a process of its own. Variants take turns seed
/// by seed, so that what else the machine does meets all of them.
/// @param cells as of `cellsOf`, with the runs of earlier sessions.
/// @pre checkCampaign passed; the caller has one thread.
CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options,
                           std::vector<CampaignCell> cells);
CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options = {});

}  // namespace corridor
