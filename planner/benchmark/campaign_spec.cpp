#include "planner/benchmark/campaign_spec.h"

#include <nlohmann/json.hpp>

#include "collision/core/shortest.h"

namespace corridor {
namespace {

/// Returns all limits as a text of numbers.
std::string limitsText(const JointLimits& limits) {
  std::string text;
  for (const Configuration* each : {&limits.velocity, &limits.acceleration, &limits.jerk}) {
    for (const double value : *each) text += shortest(value) + " ";
    text += "| ";
  }
  for (const LinkSpeed& link : limits.links) text += link.link + ": " + shortest(link.speed) + " ";
  text.pop_back();
  return text;
}

}  // namespace

std::string specOf(const Campaign& campaign, const CampaignCell& cell) {
  const Problem planned = problemOfRun(campaign, cell, 0);
  nlohmann::ordered_json checker = nlohmann::ordered_json::object();
  for (const YamlValue::Entry& entry : campaign.variants[cell.variant].checker.entries)
    checker[entry.key] = entry.value.text;
  if (campaign.variants[cell.variant].competitor)
    checker["peer"] = campaign.variants[cell.variant].competitor->name;
  // In earlier versions, `simplify: true` meant another simplifier. Runs of the two simplifiers
  // must not be mixed, so this one is stored under its own name.
  const bool isOwn = planned.settings.simplify == Simplifier::corridor;
  const std::string simplify = isOwn ? "corridor" : wordOf(planned.settings.simplify);
  nlohmann::ordered_json spec{{"problem", campaign.digests[cell.problem]},
                              {"checker", checker},
                              {"planner", planned.settings.planner.name},
                              {"params", planned.settings.planner.params},
                              {"time", planned.settings.planner.time},
                              {"memory_mb", campaign.limits.memory},
                              {"simplify", simplify},
                              {"verify", campaign.verify}};
  // Without trajectories, the text is the same as in versions that had no trajectories.
  if (!campaign.trajectories.makers.empty()) {
    for (const TrajectoryMaker maker : campaign.trajectories.makers)
      spec["trajectories"].push_back(nameOf(maker));
    for (const CampaignLimits& limits : campaign.trajectories.limits)
      spec["limits over time"].push_back(
          {{"name", limits.name}, {"values", limitsText(limits.ofProblem[cell.problem])}});
  }
  return spec.dump();
}

SpecDifference specDifference(const std::string& a, const std::string& b) {
  const auto of = nlohmann::json::parse(a), other = nlohmann::json::parse(b);
  const auto value = [](const nlohmann::json& spec, const std::string& key) {
    return spec.contains(key) ? spec[key].dump() : "not set";
  };
  for (const auto* all : {&other, &of})
    for (const auto& [key, unused] : all->items())
      if (value(of, key) != value(other, key)) return {key, value(of, key), value(other, key)};
  return {"order of settings", a, b};
}

std::string cellName(const Campaign& campaign, const CampaignCell& cell) {
  return campaign.problemNames[cell.problem] + ", " + campaign.variants[cell.variant].name + ", " +
         cell.planner.label;
}

}  // namespace corridor
