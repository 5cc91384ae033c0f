#include "planner/app/limits_output.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "planner/app/output.h"
#include "planner/trajectory/rows_limits.h"

namespace corridor::app {

std::string limitsText(const Problem& problem, const LimitRatios& ratios) {
  std::string text = keepsLimits(ratios) ? "kept at every instant" : "exceeded";
  const std::vector<std::string> numbers = problem.model.space.numberNames();
  const auto add = [&](const char* what, const LimitShare& share, const std::string& name) {
    // Rounded up, so that a limit that is exceeded never shows as 100 %.
    text += std::string("; ") + what + " " + rounded(std::ceil(1e3 * share.share) / 10) + " % (" +
            name + ")";
  };
  if (ratios.velocity.share > 0) add("velocity", ratios.velocity, numbers[ratios.velocity.number]);
  if (ratios.acceleration.share > 0)
    add("acceleration", ratios.acceleration, numbers[ratios.acceleration.number]);
  if (ratios.jerk.share > 0) add("jerk", ratios.jerk, numbers[ratios.jerk.number]);
  if (ratios.link.share > 0)
    add("speed of links", ratios.link, problem.task.limits.links[ratios.link.number].link);
  if (ratios.position.share > 0)
    text += "; position beyond the bounds by " + rounded(ratios.position.share) + " (" +
            numbers[ratios.position.number] + ")";
  return text;
}

void addLimits(nlohmann::ordered_json& json, const LimitRatios& ratios) {
  json["limits"] = keepsLimits(ratios) ? "kept" : "exceeded";
  json["velocity_share"] = numberJson(ratios.velocity.share);
  json["acceleration_share"] = numberJson(ratios.acceleration.share);
  json["jerk_share"] = numberJson(ratios.jerk.share);
  json["link_speed_share"] = numberJson(ratios.link.share);
}

}  // namespace corridor::app
