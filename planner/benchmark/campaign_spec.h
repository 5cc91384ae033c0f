#pragma once

#include <string>

#include "planner/benchmark/campaign.h"

/// The settings that must be equal in two databases that belong to one campaign.
namespace corridor {

/// Returns, as JSON, the settings of a cell that must be the same in all sessions: the problem's
/// digest, checker, planner with its parameters, limits, `simplify` and `verify`.
std::string specOf(const Campaign& campaign, const CampaignCell& cell);

/// The first setting that differs between two specs. Values are JSON, or "not set".
struct SpecDifference {
  std::string key, a, b;
};
/// @pre the specs differ. @throws nlohmann::json::exception if one of them is no JSON.
SpecDifference specDifference(const std::string& a, const std::string& b);

/// Returns "problem, variant, planner", for messages.
std::string cellName(const Campaign& campaign, const CampaignCell& cell);

}  // namespace corridor
