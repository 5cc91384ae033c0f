#include "planner/benchmark/campaign.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "collision/core/nearest.h"
#include "planner/benchmark/child_process.h"

namespace corridor {
namespace {

/// Seconds for setting up one run while checking: goals are sampled, trees are built.
constexpr double kCheckPatience = 120;

void faultRepeated(const std::string& option, const std::vector<std::string>& words,
                   std::vector<Fault>& faults) {
  std::set<std::string> seen;
  for (const std::string& word : words)
    if (!seen.insert(word).second)
      faults.push_back({option, 0, quotedWord(word) + " is named twice"});
}

std::vector<CampaignCell> cellsOf(const Campaign& c) {
  std::vector<CampaignCell> cells;
  for (std::size_t p = 0; p < c.problems.size(); ++p) {
    std::vector<std::string> planners = c.planners;
    if (planners.empty()) planners = {c.problems[p].planner.name};
    for (const std::string& planner : planners)
      for (std::size_t v = 0; v < c.variants.size(); ++v) cells.push_back({p, v, planner, {}});
  }
  return cells;
}

/// "plate", and of another one of that name "plate-2".
std::vector<std::string> namesOf(const std::vector<Problem>& problems) {
  std::vector<std::string> names;
  for (const Problem& problem : problems) {
    std::string name = problem.name;
    for (int i = 2; std::find(names.begin(), names.end(), name) != names.end(); ++i)
      name = problem.name + "-" + std::to_string(i);
    names.push_back(name);
  }
  return names;
}

/// What is wrong with the cells, each fault once, in order. OMPL has one stream of random numbers a
/// process: setting up here would leave a mark on it.
std::vector<Fault> faultsInChild(const Campaign& campaign) {
  const std::vector<CampaignCell> cells = cellsOf(campaign);
  const auto work = [&](const auto& send) {
    nlohmann::json faults = nlohmann::json::array();
    for (const CampaignCell& cell : cells) {
      std::map<std::string, std::string> elsewhere;
      if (!campaign.planners.empty()) elsewhere["planner.name"] = "--planners";
      try {
        checkRun(plannedProblem(campaign, cell, campaign.seed), elsewhere);
      } catch (const InputError& error) {
        for (const Fault& f : error.faults()) {
          const nlohmann::json fault{f.file, f.line, f.text};
          if (std::find(faults.begin(), faults.end(), fault) == faults.end())
            faults.push_back(fault);
        }
      }
    }
    send(faults.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  };
  const ChildEnd end = inChild(work, {{kCheckPatience * static_cast<double>(cells.size())}, 0});
  if (end.messages.empty())
    throw std::runtime_error("setting up the problems, to check them, was " + end.failure);
  std::vector<Fault> faults;
  for (const auto& f : nlohmann::json::parse(end.messages[0]))
    faults.push_back({f[0].get<std::string>(), f[1].get<int>(), f[2].get<std::string>()});
  return faults;
}

}  // namespace

Problem plannedProblem(const Campaign& campaign, const CampaignCell& cell, std::uint64_t seed) {
  Problem problem = campaign.problems[cell.problem];
  campaign.variants[cell.variant].apply(problem.checker);
  if (cell.planner != problem.planner.name) {
    problem.planner.name = cell.planner;
    problem.planner.params.clear();  // they were another planner's
  }
  problem.planner.time = campaign.time.value_or(problem.planner.time);
  problem.seed = seed;
  return problem;
}

void checkCampaign(const Campaign& campaign) {
  std::vector<Fault> faults;
  std::vector<std::string> variants;
  for (const Variant& variant : campaign.variants) variants.push_back(variant.name);
  faultRepeated("--variants", variants, faults);
  faultRepeated("--planners", campaign.planners, faults);
  if (campaign.problems.empty()) faults.push_back({"", 0, "a problem is needed"});
  if (variants.empty()) faults.push_back({"--variants", 0, "a variant is needed"});
  if (campaign.runs == 0) faults.push_back({"--runs", 0, "1 or more are needed, not 0"});
  if (faults.empty()) faults = faultsInChild(campaign);
  if (!faults.empty()) throw InputError(std::move(faults));
}

CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options) {
  CampaignResult result;
  result.names = namesOf(campaign.problems);
  result.cells = cellsOf(campaign);
  result.start = std::chrono::system_clock::now();
  const std::size_t variants = campaign.variants.size();
  std::uint64_t done = 0;
  const auto run = [&](CampaignCell& cell, std::uint64_t seed) {
    const Variant& variant = campaign.variants[cell.variant];
    if (options.progress)
      options.progress({done, result.cells.size() * campaign.runs, result.names[cell.problem],
                        variant.name, cell.planner, seed});
    BenchmarkRun one =
        runInChild(campaign.problems[cell.problem], plannedProblem(campaign, cell, seed),
                   variant.peer, campaign.limits, options.interrupted);
    result.interrupted = options.interrupted && options.interrupted->load();
    if (!result.interrupted) cell.runs.push_back(std::move(one));
    ++done;
  };
  // A problem's and a planner's variants are neighbours.
  for (std::size_t first = 0; first < result.cells.size(); first += variants)
    for (std::uint64_t i = 0; i < campaign.runs; ++i)
      for (std::size_t v = 0; v < variants && !result.interrupted; ++v)
        run(result.cells[first + v], campaign.seed + i);
  result.seconds =
      std::chrono::duration<double>(std::chrono::system_clock::now() - result.start).count();
  return result;
}

}  // namespace corridor
