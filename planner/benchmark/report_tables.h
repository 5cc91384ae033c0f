#pragma once

#include <string>
#include <vector>

#include "planner/benchmark/comparison.h"
#include "planner/benchmark/run_file.h"

/// The tables of a campaign's report, as HTML.
namespace corridor {

/// One row per variant in order of rank. Columns: refuted paths, solved runs, time, share of the
/// time in checking, and the ratio of the path's length after simplifying to its length before.
std::string rankingTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                         const std::vector<VariantScore>& scores);
/// One row per variant whose tests are counted: C_v, C_p, and how well they predict the time.
std::string costTable(const Campaign& campaign, const std::vector<VariantScore>& scores);
/// One row per variant, set of limits and maker of trajectories.
std::string trajectoryTable(const Campaign& campaign, const std::vector<CampaignCell>& cells);
/// For a problem, one row per planner and variant.
std::string cellTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                      std::size_t problem);
/// What a reader needs to reproduce the figures: machine, program, sessions, limits, planners,
/// variants, problems.
std::string measuredTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                          const std::vector<CampaignSession>& sessions);

/// Returns a variant's name after a swatch of its colour.
std::string variantHtml(const Campaign& campaign, std::size_t variant);

}  // namespace corridor
