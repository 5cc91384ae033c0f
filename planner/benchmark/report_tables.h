#pragma once

#include <string>
#include <vector>

#include "planner/benchmark/campaign_database.h"
#include "planner/benchmark/comparison.h"

/// The tables of a campaign's report, as HTML.
namespace corridor {

/// A line a variant, as ranked: refuted, solved, time, share of checking, length left.
std::string rankingTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                         const std::vector<VariantScore>& scores);
/// A line a variant that counts its tests: C_v, C_p, and how well they predict.
std::string costTable(const Campaign& campaign, const std::vector<VariantScore>& scores);
/// Of a problem, a line a planner and variant.
std::string cellTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                      std::size_t problem);
/// What somebody needs who wants to have the same figures: machine, program, sessions, limits,
/// planners, variants, problems.
std::string measuredTable(const Campaign& campaign, const std::vector<CampaignCell>& cells,
                          const std::vector<CampaignSession>& sessions);

/// A variant's name behind its colour.
std::string variantHtml(const Campaign& campaign, std::size_t variant);

}  // namespace corridor
