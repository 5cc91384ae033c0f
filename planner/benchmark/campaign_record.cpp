#include "planner/benchmark/campaign_record.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "collision/core/shortest.h"

namespace corridor {
namespace {

using nlohmann::ordered_json;

[[noreturn]] void damagedRecord(const std::string& what) {
  throw std::invalid_argument("the campaign's record has " + what);
}

/// Returns numbers as texts. They may be infinite, and JSON has no infinity.
ordered_json textsOf(const Configuration& numbers) {
  ordered_json texts = ordered_json::array();
  for (const double number : numbers) texts.push_back(shortest(number));
  return texts;
}
Configuration numbersOf(const ordered_json& texts) {
  Configuration numbers(static_cast<Eigen::Index>(texts.size()));
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const std::string text = texts[i];
    double& number = numbers[static_cast<Eigen::Index>(i)];
    const auto end = text.data() + text.size();
    if (std::from_chars(text.data(), end, number).ptr != end) damagedRecord("\"" + text + "\"");
  }
  return numbers;
}

template <class Choice>
Choice choiceIn(const ordered_json& word) {
  const auto choice = choiceNamed<Choice>(word.get<std::string>());
  if (!choice) damagedRecord(word.dump());
  return *choice;
}
std::optional<Simplifier> simplifierIn(const ordered_json& json) {
  if (!json.contains("simplify")) return std::nullopt;
  return choiceIn<Simplifier>(json["simplify"]);
}

ordered_json jsonOf(const JointLimits& limits) {
  ordered_json json{{"velocity", textsOf(limits.velocity)},
                    {"acceleration", textsOf(limits.acceleration)},
                    {"jerk", textsOf(limits.jerk)}};
  for (const LinkSpeed& link : limits.links)
    json["links"].push_back({{"link", link.link}, {"speed", link.speed}});
  return json;
}
JointLimits limitsIn(const ordered_json& json) {
  JointLimits limits;
  limits.velocity = numbersOf(json.at("velocity"));
  limits.acceleration = numbersOf(json.at("acceleration"));
  limits.jerk = numbersOf(json.at("jerk"));
  for (const ordered_json& link : json.value("links", ordered_json::array()))
    limits.links.push_back({link.at("link"), 0, link.at("speed"), {}});
  return limits;
}

ordered_json jsonOf(const CheckerSettings& checker) {
  const TreeNames& trees = checker.trees;
  ordered_json json{{"edges", wordOf(checker.edges)},
                    {"resolution", checker.resolution},
                    {"trees", {trees.volume, trees.fit, trees.overlap, trees.build}}};
  if (checker.tolerance) json["tolerance"] = *checker.tolerance;
  return json;
}
CheckerSettings checkerIn(const ordered_json& json) {
  CheckerSettings checker;
  checker.edges = choiceIn<EdgeMethod>(json.at("edges"));
  checker.resolution = json.at("resolution");
  const ordered_json& trees = json.at("trees");
  checker.trees = {trees.at(0), trees.at(1), trees.at(2), trees.at(3)};
  if (json.contains("tolerance")) checker.tolerance = json["tolerance"].get<double>();
  return checker;
}

ordered_json jsonOf(const Problem& problem) {
  const Settings& settings = problem.settings;
  return {{"planner", settings.planner.name},    {"params", settings.planner.params},
          {"time", settings.planner.time},       {"simplify", wordOf(settings.simplify)},
          {"checker", jsonOf(settings.checker)}, {"margin", problem.task.margin}};
}
Problem problemIn(const ordered_json& json) {
  Problem problem;
  Settings& settings = problem.settings;
  settings.planner.name = json.at("planner");
  json.at("params").get_to(settings.planner.params);
  settings.planner.time = json.at("time");
  settings.simplify = choiceIn<Simplifier>(json.at("simplify"));
  settings.checker = checkerIn(json.at("checker"));
  problem.task.margin = json.at("margin");
  return problem;
}

ordered_json jsonOf(const Variant& variant) {
  ordered_json json{{"name", variant.name}, {"checker", ordered_json::array()}};
  for (const YamlValue::Entry& entry : variant.checker.entries)
    json["checker"].push_back({entry.key, entry.value.text});
  if (variant.competitor) json["peer"] = {variant.competitor->name, variant.competitor->version};
  return json;
}
Variant variantIn(const ordered_json& json) {
  std::vector<std::pair<std::string, std::string>> keys;
  for (const ordered_json& entry : json.at("checker")) keys.emplace_back(entry.at(0), entry.at(1));
  Variant variant{json.at("name"), checkerMap(keys), {}};
  if (json.contains("peer")) {
    variant.competitor.emplace();
    variant.competitor->name = json["peer"].at(0);
    variant.competitor->version = json["peer"].at(1);
  }
  return variant;
}

ordered_json jsonOf(const CampaignPlanner& planner) {
  ordered_json json{{"label", planner.label}, {"name", planner.name}};
  if (planner.params) json["params"] = *planner.params;
  if (planner.simplify) json["simplify"] = wordOf(*planner.simplify);
  return json;
}
CampaignPlanner plannerIn(const ordered_json& json) {
  CampaignPlanner planner{json.at("label"), json.at("name"), {}};
  if (json.contains("params")) json["params"].get_to(planner.params.emplace());
  planner.simplify = simplifierIn(json);
  return planner;
}

ordered_json jsonOf(const CampaignTrajectories& trajectories) {
  ordered_json json{{"makers", ordered_json::array()}, {"limits", ordered_json::array()}};
  for (const TrajectoryMaker maker : trajectories.makers) json["makers"].push_back(nameOf(maker));
  for (const CampaignLimits& limits : trajectories.limits) {
    ordered_json set{{"name", limits.name}, {"of", ordered_json::array()}};
    for (const JointLimits& of : limits.ofProblem) set["of"].push_back(jsonOf(of));
    json["limits"].push_back(std::move(set));
  }
  return json;
}
CampaignTrajectories trajectoriesIn(const ordered_json& json, std::size_t problems) {
  CampaignTrajectories trajectories;
  for (const ordered_json& name : json.at("makers")) {
    const auto maker = trajectoryMakerNamed(name);
    if (!maker) damagedRecord(name.dump());
    trajectories.makers.push_back(*maker);
  }
  for (const ordered_json& set : json.at("limits")) {
    CampaignLimits limits{set.at("name"), {}};
    for (const ordered_json& of : set.at("of")) limits.ofProblem.push_back(limitsIn(of));
    if (limits.ofProblem.size() != problems) damagedRecord("limits of another number of problems");
    trajectories.limits.push_back(std::move(limits));
  }
  return trajectories;
}

}  // namespace

ordered_json recordOf(const Campaign& campaign) {
  ordered_json json{{"name", campaign.name},     {"seed", campaign.seed},
                    {"runs", campaign.runs},     {"memory_mb", campaign.limits.memory},
                    {"verify", campaign.verify}, {"notes", campaign.notes}};
  if (campaign.time) json["time"] = *campaign.time;
  if (campaign.cache) json["cache"] = true;
  if (campaign.simplify) json["simplify"] = wordOf(*campaign.simplify);
  for (const char* list : {"problems", "variants", "planners"}) json[list] = ordered_json::array();
  for (std::size_t p = 0; p < campaign.problems.size(); ++p) {
    json["problems"].push_back(jsonOf(campaign.problems[p]));
    json["problems"].back()["name"] = campaign.problemNames[p];
    json["problems"].back()["digest"] = campaign.digests[p];
  }
  for (const Variant& variant : campaign.variants) json["variants"].push_back(jsonOf(variant));
  for (const CampaignPlanner& planner : campaign.planners)
    json["planners"].push_back(jsonOf(planner));
  if (!campaign.trajectories.makers.empty()) json["trajectories"] = jsonOf(campaign.trajectories);
  return json;
}

Campaign campaignOfRecord(const ordered_json& json) {
  Campaign campaign;
  campaign.name = json.at("name");
  campaign.seed = json.at("seed");
  campaign.runs = json.at("runs");
  campaign.limits.memory = json.at("memory_mb");
  campaign.verify = json.at("verify");
  json.at("notes").get_to(campaign.notes);
  if (json.contains("time")) campaign.time = json["time"].get<double>();
  campaign.cache = json.value("cache", false);
  campaign.simplify = simplifierIn(json);
  for (const ordered_json& problem : json.at("problems")) {
    campaign.problems.push_back(problemIn(problem));
    campaign.problemNames.push_back(problem.at("name"));
    campaign.digests.push_back(problem.at("digest"));
  }
  for (const ordered_json& variant : json.at("variants"))
    campaign.variants.push_back(variantIn(variant));
  for (const ordered_json& planner : json.at("planners"))
    campaign.planners.push_back(plannerIn(planner));
  if (json.contains("trajectories"))
    campaign.trajectories = trajectoriesIn(json["trajectories"], campaign.problems.size());
  return campaign;
}

}  // namespace corridor
