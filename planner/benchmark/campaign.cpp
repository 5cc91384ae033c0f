#include "planner/benchmark/campaign.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "collision/core/spelling.h"
#include "planner/problem/digest.h"

namespace corridor {
namespace {

/// Time limit in seconds, for each cell, of the child process that sets up all cells to find their
/// faults. Setting up a cell samples goals and builds trees.
constexpr double kCheckPatience = 120;
/// The largest number of runs. It limits the memory for the results, half a kilobyte per run and
/// more with trajectories.
constexpr std::uint64_t kMostRuns = 1'000'000;
constexpr std::uint64_t kLastSeed = 0xffffffff;  // OMPL's seeds have 32 bits

std::string placeOf(const Campaign& campaign, const std::string& what) {
  const auto place = campaign.places.find(what);
  return place != campaign.places.end() ? place->second : "--" + what;
}

std::string placeOf(const Campaign& campaign, const CampaignPlanner& planner) {
  return planner.place.empty() ? placeOf(campaign, "planners") : planner.place;
}

/// Collects names of variants or planners, and adds a fault for each name that is repeated.
class Names {
 public:
  explicit Names(std::vector<Fault>& faults) : faults_(faults) {}
  void add(const std::string& name, const std::string& place) {
    if (!seen_.insert(name).second)
      faults_.push_back({place, 0, quotedWord(name) + " is named twice"});
  }

 private:
  std::vector<Fault>& faults_;
  std::set<std::string> seen_;
};

/// Returns a name as UTF-8 in one line, so that tables, plots and JSON can show it. (A folder's
/// name may contain any bytes.)
std::string printable(const std::string& name) {
  const auto replace = nlohmann::json::error_handler_t::replace;
  std::string text =
      nlohmann::json::parse(nlohmann::json(name).dump(-1, ' ', false, replace)).get<std::string>();
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

/// Sets up all cells, and returns their faults, each once, in the order of the cells. This is done
/// in a child process, because set-up advances OMPL's random numbers, of which a process has only
/// one stream.
std::vector<Fault> faultsInChild(const Campaign& campaign) {
  const std::vector<CampaignCell> cells = cellsOf(campaign);
  const auto work = [&](const auto& send) {
    nlohmann::json faults = nlohmann::json::array();
    for (const CampaignCell& cell : cells) {
      std::map<std::string, std::string> elsewhere;
      const std::string place = placeOf(campaign, cell.planner);
      if (!campaign.planners.empty()) elsewhere["planner.name"] = place;
      if (cell.planner.params)
        for (const auto& [key, value] : *cell.planner.params)
          elsewhere["planner.params." + key] = place;
      try {
        checkRun(problemOfRun(campaign, cell, campaign.seed), elsewhere);
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
    throw std::runtime_error("setting up the problems to check them failed: " + end.failure);
  std::vector<Fault> faults;
  for (const auto& f : nlohmann::json::parse(end.messages[0]))
    faults.push_back({f[0].get<std::string>(), f[1].get<int>(), f[2].get<std::string>()});
  return faults;
}

}  // namespace

void identifyProblems(Campaign& campaign) {
  std::vector<std::string>& names = campaign.problemNames;
  names.clear();
  for (const Problem& problem : campaign.problems) {
    const std::string plain = printable(problem.source.name);
    std::string name = plain;
    for (int i = 2; std::find(names.begin(), names.end(), name) != names.end(); ++i)
      name = plain + "-" + std::to_string(i);
    names.push_back(name);
  }
  campaign.digests.clear();
  for (const Problem& problem : campaign.problems) campaign.digests.push_back(digestOf(problem));
}

std::vector<CampaignCell> cellsOf(const Campaign& c) {
  std::vector<CampaignCell> cells;
  for (std::size_t p = 0; p < c.problems.size(); ++p) {
    std::vector<CampaignPlanner> planners = c.planners;
    const std::string& own = c.problems[p].settings.planner.name;
    if (planners.empty()) planners = {{own, own, {}}};
    for (const CampaignPlanner& planner : planners)
      for (std::size_t v = 0; v < c.variants.size(); ++v) cells.push_back({p, v, planner, {}});
  }
  return cells;
}

RunSource runsOf(const std::vector<CampaignCell>& cells) {
  return [&cells](std::size_t cell, const std::function<void(const BenchmarkRun&)>& visit) {
    for (const BenchmarkRun& run : cells[cell].runs) visit(run);
  };
}

bool hasRun(const Campaign& campaign, std::size_t cell, std::size_t cells, std::uint64_t seed) {
  if (seed < campaign.seed || seed - campaign.seed >= campaign.runs) return false;
  // cellsOf puts the variants of a problem and planner next to each other.
  const std::size_t variants = campaign.variants.size();
  return !campaign.shard ||
         campaign.shard->contains(cell / variants, cells / variants, seed - campaign.seed);
}

Problem problemOfRun(const Campaign& campaign, const CampaignCell& cell, std::uint64_t seed) {
  Problem problem = campaign.problems[cell.problem];
  campaign.variants[cell.variant].apply(problem.settings.checker);
  if (cell.planner.params)
    problem.settings.planner.params = *cell.planner.params;
  else if (cell.planner.name != problem.settings.planner.name)
    problem.settings.planner.params.clear();  // they belong to the problem's own planner
  problem.settings.planner.name = cell.planner.name;
  problem.settings.planner.time = campaign.time.value_or(problem.settings.planner.time);
  problem.settings.simplify =
      cell.planner.simplify.value_or(campaign.simplify.value_or(problem.settings.simplify));
  problem.settings.seed = seed;
  // A preferred clearance would make paths longer, and competitors can't keep one. So no variant
  // prefers a clearance.
  problem.settings.prefer.clearance = 0;
  return problem;
}

RunTrajectories trajectoriesOf(const Campaign& campaign, const CampaignCell& cell) {
  RunTrajectories trajectories;
  trajectories.makers = campaign.trajectories.makers;
  if (trajectories.makers.empty()) return trajectories;
  for (const CampaignLimits& limits : campaign.trajectories.limits)
    trajectories.limits.push_back(limits.ofProblem[cell.problem]);
  return trajectories;
}

void checkCampaign(const Campaign& campaign) {
  std::vector<Fault> faults;
  Names variants(faults), planners(faults);
  for (const Variant& variant : campaign.variants)
    variants.add(variant.name, placeOf(campaign, "variants"));
  for (const CampaignPlanner& planner : campaign.planners)
    planners.add(planner.label, placeOf(campaign, planner));
  if (campaign.problems.empty()) faults.push_back({"", 0, "a problem is needed"});
  if (campaign.variants.empty())
    faults.push_back({placeOf(campaign, "variants"), 0, "a variant is needed"});
  if (!campaign.trajectories.makers.empty() && !campaign.verify)
    faults.push_back({placeOf(campaign, "trajectories"), 0,
                      "their verdicts are the verifier's; leave out verify: false"});
  if (campaign.runs == 0)
    faults.push_back({placeOf(campaign, "runs"), 0, "1 or more are needed, not 0"});
  const std::uint64_t cells = campaign.problems.size() * campaign.variants.size() *
                              std::max<std::uint64_t>(campaign.planners.size(), 1);
  if (cells > 0 && campaign.runs > kMostRuns / cells)
    faults.push_back({placeOf(campaign, "runs"), 0,
                      "more than " + std::to_string(kMostRuns) +
                          " runs in all: " + std::to_string(campaign.runs) + " of each of " +
                          std::to_string(cells) + " combinations of problem, checker and planner"});
  if (campaign.runs > kLastSeed - campaign.seed + 1)
    faults.push_back({placeOf(campaign, "runs"), 0, "the last seed would be above 2^32 - 1"});
  const std::uint64_t groups = campaign.variants.empty() ? 0 : cells / campaign.variants.size();
  if (campaign.shard && faults.empty() && campaign.shard->count > groups * campaign.runs)
    faults.push_back({placeOf(campaign, "shard"), 0,
                      std::to_string(campaign.shard->count) + " shards are too many for " +
                          std::to_string(groups * campaign.runs) +
                          " combinations of problem, planner and seed: some would have no runs"});
  if (faults.empty()) faults = faultsInChild(campaign);
  if (!faults.empty()) throw InputError(std::move(faults));
}

}  // namespace corridor
