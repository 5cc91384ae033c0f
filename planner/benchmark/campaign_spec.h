#pragma once

#include <string>

#include "planner/benchmark/campaign.h"

/// The settings that must be equal in two databases that belong to one campaign.
namespace corridor {

/// Returns, as JSON, the settings of a cell that must be the same in all sessions: the problem's
/// digest, the variant's checker, the planner with its parameters, the limits of time and memory,
/// `simplify`, `verify`, and the makers and limits of trajectories, if there are any.
std::string specOf(const Campaign& campaign, const CampaignCell& cell);

/// The first setting that differs between two specs. Values are JSON, or "not set".
struct SpecDifference {
  std::string key, a, b;
};
/// Returns the first difference of two specs. @pre the specs differ. @throws
/// nlohmann::json::exception if one of them is no JSON.
SpecDifference specDifference(const std::string& a, const std::string& b);

/// Returns "problem, variant, planner", for messages.
std::string cellName(const Campaign& campaign, const CampaignCell& cell);

}  // namespace corridor
