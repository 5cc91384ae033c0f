#include "planner/benchmark/campaign_spec.h"

#include <map>
#include <tuple>

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

/// Returns the first setting that differs, such as "time 77.0, not 20.0".
std::string differenceOf(const std::string& a, const std::string& b) {
  const auto of = nlohmann::json::parse(a), other = nlohmann::json::parse(b);
  const auto value = [](const nlohmann::json& spec, const std::string& key) {
    return spec.contains(key) ? spec[key].dump() : "not set";
  };
  for (const auto* all : {&other, &of})
    for (const auto& [key, unused] : all->items())
      if (value(of, key) != value(other, key))
        return key + " " + value(of, key) + ", not " + value(other, key);
  return "its settings in another order";
}

}  // namespace

std::string specOf(const Campaign& campaign, const CampaignCell& cell) {
  const Problem planned = problemOfRun(campaign, cell, 0);
  nlohmann::ordered_json checker = nlohmann::ordered_json::object();
  for (const YamlValue::Entry& entry : campaign.variants[cell.variant].checker.entries)
    checker[entry.key] = entry.value.text;
  if (campaign.variants[cell.variant].competitor)
    checker["peer"] = campaign.variants[cell.variant].competitor->name;
  nlohmann::ordered_json spec{{"problem", campaign.digests[cell.problem]},
                              {"checker", checker},
                              {"planner", planned.settings.planner.name},
                              {"params", planned.settings.planner.params},
                              {"time", planned.settings.planner.time},
                              {"memory_mb", campaign.limits.memory},
                              {"simplify", wordOf(planned.settings.simplify)},
                              {"verify", campaign.verify},
                              {"cache", campaign.cache}};
  if (!campaign.trajectories.makers.empty()) {
    for (const TrajectoryMaker maker : campaign.trajectories.makers)
      spec["trajectories"].push_back(nameOf(maker));
    for (const CampaignLimits& limits : campaign.trajectories.limits)
      spec["limits over time"].push_back(
          {{"name", limits.name}, {"values", limitsText(limits.ofProblem[cell.problem])}});
  }
  return spec.dump();
}

std::string cellName(const Campaign& campaign, const CampaignCell& cell) {
  return campaign.problemNames[cell.problem] + ", " + campaign.variants[cell.variant].name + ", " +
         cell.planner.label;
}

std::vector<CellMatch> matchCells(const Campaign& of, const Campaign& campaign) {
  const std::vector<CampaignCell> cells = cellsOf(campaign);
  std::map<std::tuple<std::string, std::string, std::string>, std::size_t> indices;
  const auto namesOf = [](const Campaign& c, const CampaignCell& cell) {
    return std::tuple(c.problemNames[cell.problem], c.variants[cell.variant].name,
                      cell.planner.label);
  };
  for (std::size_t i = 0; i < cells.size(); ++i) indices[namesOf(campaign, cells[i])] = i;
  std::vector<CellMatch> matches;
  for (const CampaignCell& cell : cellsOf(of)) {
    CellMatch& match = matches.emplace_back();
    if (const auto found = indices.find(namesOf(of, cell)); found != indices.end()) {
      match.index = found->second;
      const std::string was = specOf(of, cell), is = specOf(campaign, cells[*match.index]);
      if (was != is)
        match.fault = cellName(of, cell) + " was measured with " + differenceOf(was, is);
    } else {
      match.fault = "it has runs of " + cellName(of, cell);
    }
  }
  return matches;
}

}  // namespace corridor
