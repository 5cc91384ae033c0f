#pragma once

#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/campaign_database.h"
#include "planner/benchmark/run_campaign.h"

/// What `corridor benchmark` prints besides its table.
namespace corridor::app {

/// Prints a line on stderr over the line before:
/// "[####······] 41 of 240, 2:10 left: piano, certified, RRT, seed 2".
void showProgress(const Campaign& campaign, const CampaignProgress& progress);

/// Returns what a reader of the results must know: runs of several builds or on several machines,
/// and competitors that leave out a margin.
std::vector<std::string> notesOf(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                                 const std::vector<CampaignSession>& sessions);

/// Returns the object that --json prints.
std::string campaignJson(const Campaign& campaign, const CampaignResult& result);

}  // namespace corridor::app
