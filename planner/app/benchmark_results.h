#pragma once

#include <filesystem>
#include <optional>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/run_file.h"

namespace corridor::app {

/// Where the results of `corridor benchmark` go.
struct BenchmarkTarget {
  std::optional<std::filesystem::path> folder;  ///< unset: only stdout
  const RunFile* runs = nullptr;                ///< in this folder; null without a folder
  bool json = false;                            ///< print JSON on stdout, not the tables
};

/// Warns of what readers of the results must know, writes the reports into the folder, and prints
/// the tables or the JSON. If no run is finished, no report is written and no table is printed. The
/// JSON, if chosen, is printed even then.
/// @param campaign gets the notes on the results.
/// @throws InputError if a file can't be written; the results are printed first.
void giveResults(Campaign& campaign, const CampaignResult& result, const BenchmarkTarget& target);

/// Returns whether any cell has a finished run.
bool anyRun(const std::vector<CampaignCell>& cells);

}  // namespace corridor::app
