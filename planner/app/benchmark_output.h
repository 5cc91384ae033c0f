#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/run_campaign.h"
#include "planner/benchmark/run_file.h"

/// The output of `corridor benchmark` except its tables: the progress line, notes, the list of
/// failures, and the JSON.
namespace corridor::app {

/// Prints a progress line on stderr, over the previous progress line:
/// "[####······] 41 of 240, 2:10 left: piano, certified, RRT, seed 2".
void showProgress(const Campaign& campaign, const CampaignProgress& progress);

/// Returns notes for the readers of the results: on runs of several builds or machines, and on
/// competitors that ignore a margin.
std::vector<std::string> notesOf(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                                 const std::vector<CampaignSession>& sessions);

/// Returns a line for each distinct reason for which runs failed, the most frequent first: "3 runs
/// failed: out of memory". `runs.csv` has the reason of each run.
std::vector<std::string> failuresOf(const std::vector<CampaignCell>& cells);

/// Prints the JSON object of the option --json. @param runs the source of the complete data of all
/// runs in the result's cells.
void printJson(const Campaign& campaign, const CampaignResult& result, const RunSource& runs,
               std::ostream& out);

}  // namespace corridor::app
