#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "planner/problem/problem.h"
#include "planner/trajectory/limits_proof.h"

namespace corridor::app {

/// Returns "kept at every instant; velocity 97.3 % (elbow); …", "exceeded; …", or "not all tested;
/// …" with the limits that were not.
std::string limitsText(const Problem& problem, const LimitRatios& ratios);
/// Adds `limits` (`limitsVerdict`) and the share of each limit to a JSON object. The share of
/// a limit that was not tested is null.
void addLimits(nlohmann::ordered_json& json, const LimitRatios& ratios);

}  // namespace corridor::app
