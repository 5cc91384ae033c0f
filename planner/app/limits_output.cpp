#include "planner/app/limits_output.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "collision/core/shortest.h"
#include "planner/app/output.h"
#include "planner/trajectory/rows_limits.h"

namespace corridor::app {

std::string limitsText(const Problem& problem, const LimitRatios& ratios) {
  std::string text = keepsLimits(ratios)     ? "kept at every instant"
                     : exceedsLimits(ratios) ? "exceeded"
                                             : "not all tested; the others are kept";
  const std::vector<std::string> numbers = problem.model.space.numberNames();
  const auto add = [&](const char* what, const LimitShare& share, const std::string& name) {
    // Rounded up, so that a limit that is exceeded never shows as 100 %.
    double tenths = std::ceil(1e3 * share.share);
    if (share.share > 1) tenths = share.share <= 1 + kLimitSlack ? 1000 : std::max(tenths, 1001.0);
    text += std::string("; ") + what + " " + shortest(tenths / 10) + " % (" + name + ")";
  };
  if (ratios.velocity.share > 0) add("velocity", ratios.velocity, numbers[ratios.velocity.number]);
  if (ratios.acceleration.share > 0)
    add("acceleration", ratios.acceleration, numbers[ratios.acceleration.number]);
  if (ratios.jerk.share > 0) add("jerk", ratios.jerk, numbers[ratios.jerk.number]);
  if (ratios.link.share > 0)
    add("speed of links", ratios.link, problem.task.limits.links[ratios.link.number].link);
  for (const auto& [what, share] :
       {std::pair("acceleration", ratios.acceleration), {"jerk", ratios.jerk}})
    if (!share.tested) text += std::string("; ") + what + " not tested: it jumps at the rows";
  if (ratios.position.share > kLimitSlack)
    text += "; position beyond the bounds by " + rounded(ratios.position.share) + " (" +
            numbers[ratios.position.number] + ")";
  return text;
}

void addLimits(nlohmann::ordered_json& json, const LimitRatios& ratios) {
  json["limits"] = limitsVerdict(ratios);
  const auto add = [&](const char* key, const LimitShare& share) {
    json[key] = share.tested ? numberJson(share.share) : nlohmann::ordered_json();
  };
  add("velocity_share", ratios.velocity);
  add("acceleration_share", ratios.acceleration);
  add("jerk_share", ratios.jerk);
  add("link_speed_share", ratios.link);
  json["beyond_bounds"] = numberJson(ratios.position.share);
}

}  // namespace corridor::app
