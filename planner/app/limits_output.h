#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "planner/problem/problem.h"
#include "planner/trajectory/limits_proof.h"

namespace corridor::app {

/// Returns "kept at every instant; velocity 97.3 % (elbow); …", "exceeded; …", or "not all tested;
/// the others are kept; …". The text also lists the limits that were not tested.
std::string limitsText(const Problem& problem, const LimitRatios& ratios);
/// Adds keys to a JSON object. `limits` is the text of `limitsVerdict`. The keys `velocity_share`,
/// `acceleration_share`, `jerk_share` and `link_speed_share` are, for each kind of limit, the
/// largest fraction of a limit that the motion uses (1: all of it), or null if this kind was not
/// tested. `beyond_bounds` is the largest amount by which a position is beyond its bounds, rad or
/// m.
void addLimits(nlohmann::ordered_json& json, const LimitRatios& ratios);

}  // namespace corridor::app
