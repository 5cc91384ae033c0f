#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "planner/problem/problem.h"
#include "planner/trajectory/limits_proof.h"

namespace corridor::app {

/// Returns "kept at every instant; velocity 97.3 % (elbow); …", "exceeded; …", or "not all tested;
/// …" with the limits that were not tested.
std::string limitsText(const Problem& problem, const LimitRatios& ratios);
/// Adds the key `limits` to a JSON object. Its value has the text of `limitsVerdict` and, for each
/// limit, the share of the limit that the motion uses (1: all of it). The share of a limit that was
/// not tested is null.
void addLimits(nlohmann::ordered_json& json, const LimitRatios& ratios);

}  // namespace corridor::app
