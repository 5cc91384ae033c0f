#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "planner/problem/problem.h"
#include "planner/trajectory/limits_proof.h"

namespace corridor::app {

/// Returns "kept at every instant; velocity 97.3 % (elbow); …", or "exceeded; …". Says which limits
/// were not tested.
std::string limitsText(const Problem& problem, const LimitRatios& ratios);
/// Adds `limits` ("kept" or "exceeded") and the share of each limit to a JSON object. The share of
/// a limit that was not tested is null.
void addLimits(nlohmann::ordered_json& json, const LimitRatios& ratios);

}  // namespace corridor::app
