#include "planner/benchmark/ompl_log.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include <ompl/base/PlannerStatus.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/config.h>
#include <ompl/tools/benchmark/Benchmark.h>

#include "planner/benchmark/rows.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

using ompl::tools::Benchmark;

/// Where a run's setup stops speaking of the problem and begins to speak of the planner.
constexpr const char* kPlannersBegin = "Properties of benchmarked planners:\n";

/// OMPL's writer, of an experiment that wasn't made in this process.
class Log final : public Benchmark {
 public:
  explicit Log(og::SimpleSetup& unused) : Benchmark(unused) {}
  CompleteExperiment& experiment() { return exp_; }
};

std::string versionOfOmpl() {
  return std::to_string(OMPL_MAJOR_VERSION) + "." + std::to_string(OMPL_MINOR_VERSION) + "." +
         std::to_string(OMPL_PATCH_VERSION);
}

/// OMPL's readers take the last word of the line.
std::string oneWord(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); }, '_');
  return text;
}

std::map<std::string, std::string> propertiesOf(const Row& row, const BenchmarkRun& run) {
  std::map<std::string, std::string> properties = run.ompl.properties;
  for (const auto& [name, value] : row) {
    if (const auto* yes = std::get_if<bool>(&value))
      properties.emplace(name + " BOOLEAN", *yes ? "1" : "0");
    if (const auto* count = std::get_if<std::uint64_t>(&value))
      properties.emplace(name + " INTEGER", std::to_string(*count));
    if (const auto* number = std::get_if<double>(&value))
      properties.emplace(name + " REAL", shortest(*number));
  }
  for (const char* verdict : {"proved", "refuted", "undecided"})
    if (run.solved)
      properties[verdict + std::string(" BOOLEAN")] = run.verdict == verdict ? "1" : "0";
  if (run.result == "failed") {
    properties["status ENUM"] = std::to_string(ob::PlannerStatus::CRASH);
    properties["solved BOOLEAN"] = "0";
  }
  return properties;
}

/// OMPL's list of a planner's runs. A planner that reports progress has a list of it for each run.
Benchmark::PlannerExperiment plannerOf(const Campaign& campaign, const CampaignResult& result,
                                       const CampaignCell& cell) {
  Benchmark::PlannerExperiment planner;
  planner.name = "geometric_" + cell.planner;
  for (const BenchmarkRun& run : cell.runs) {
    planner.runs.push_back(propertiesOf(runRow(campaign, result, cell, run), run));
    planner.runsProgressData.push_back(run.ompl.progress);
    if (run.ompl.planner.empty()) continue;
    planner.name = run.ompl.planner;
    planner.common = run.ompl.settings;
    if (!run.ompl.progressNames.empty()) planner.progressPropertyNames = run.ompl.progressNames;
  }
  if (planner.progressPropertyNames.empty()) planner.runsProgressData.clear();
  return planner;
}

}  // namespace

std::string omplLog(const Campaign& campaign, const CampaignResult& result, std::size_t problem,
                    std::size_t variant) {
  const Variant& v = campaign.variants[variant];
  const Problem& p = campaign.problems[problem];
  og::SimpleSetup none(std::make_shared<ob::RealVectorStateSpace>(1));
  Log log(none);
  Benchmark::CompleteExperiment& experiment = log.experiment();
  experiment.name = oneWord(result.names[problem] + "/" + v.name);
  experiment.maxTime = campaign.time.value_or(p.planner.time);
  experiment.maxMem = campaign.limits.memory;
  experiment.runCount = static_cast<unsigned>(campaign.runs);
  experiment.startTime = result.start;
  experiment.totalDuration = result.seconds;
  experiment.seed = static_cast<std::uint_fast32_t>(campaign.seed);
  Problem::CheckerSpec checker = p.checker;
  v.apply(checker);
  log.addExperimentParameter("edges", "TEXT", v.peer ? v.peer->name : v.edges);
  if (v.samples())
    log.addExperimentParameter("resolution", "REAL", shortest(checker.resolution));
  else if (checker.tolerance)
    log.addExperimentParameter("tolerance", "REAL", shortest(*checker.tolerance));
  for (const CampaignCell& cell : result.cells) {
    if (cell.problem != problem || cell.variant != variant || cell.runs.empty()) continue;
    experiment.planners.push_back(plannerOf(campaign, result, cell));
    for (const BenchmarkRun& run : cell.runs) {
      if (run.ompl.planner.empty()) continue;
      const std::string& setup = run.ompl.setup;
      const auto planner = setup.find(kPlannersBegin);
      if (experiment.setupInfo.empty())
        experiment.setupInfo = setup;
      else if (planner != std::string::npos)
        experiment.setupInfo += setup.substr(planner + std::string(kPlannersBegin).size());
      experiment.host = oneWord(run.ompl.host);
      experiment.cpuInfo = run.ompl.cpu;
      break;
    }
  }
  std::ostringstream text;
  log.saveResultsToStream(text);
  std::string all = text.str();
  // Debian's OMPL 1.5.2 has an empty OMPL_VERSION, and its readers then take "version" for it.
  const std::string unversioned = "OMPL version \n";
  if (all.rfind(unversioned, 0) == 0)
    all.replace(0, unversioned.size(), "OMPL version " + versionOfOmpl() + "\n");
  return all;
}

}  // namespace corridor
