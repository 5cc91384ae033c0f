#pragma once

#include <filesystem>
#include <optional>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/campaign_database.h"

namespace corridor::app {

/// Where the results of `corridor benchmark` go.
struct BenchmarkTarget {
  std::optional<std::filesystem::path> folder;  ///< unset: only stdout
  const CampaignDatabase* database = nullptr;   ///< in the folder; null without one
  bool json = false;                            ///< on stdout, in place of the tables
};

/// Warns of what readers of the results must know, writes the reports into the folder, and prints
/// the tables or the JSON. Without any run nothing is written, nor any table printed.
/// @param campaign gets the notes on the results.
/// @throws InputError if a file can't be written; the results are printed before.
void giveResults(Campaign& campaign, const CampaignResult& result, const BenchmarkTarget& target);

bool anyRun(const std::vector<CampaignCell>& cells);

}  // namespace corridor::app
