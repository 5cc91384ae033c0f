#include "planner/benchmark/ompl_log.h"

#include <algorithm>
#include <cctype>
#include <ostream>
#include <set>
#include <sstream>

#include <ompl/base/PlannerStatus.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/config.h>
#include <ompl/tools/benchmark/Benchmark.h>

#include "collision/core/shortest.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/trajectory_rows.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

using ompl::tools::Benchmark;

/// The line of a run's setup text that begins its part on the planner.
constexpr const char* kPlannersBegin = "Properties of benchmarked planners:\n";

/// Gives access to OMPL's writer of logs for an experiment that this process did not run.
class Log final : public Benchmark {
 public:
  explicit Log(og::SimpleSetup& unused) : Benchmark(unused) {}
  CompleteExperiment& experiment() { return exp_; }
};

/// A planner of an experiment, without its runs.
struct LoggedPlanner {
  std::size_t cell = 0;  ///< index of the cell that has the planner's runs
  std::string name;
  std::map<std::string, std::string> settings;
  /// The keys of omplProperties that any of the planner's runs has.
  std::set<std::string> properties;
  std::vector<std::string> progressNames;
};

/// Writes a planner and its runs in the form of OMPL's Benchmark. OMPL's own writer is not used for
/// this, because it needs all runs in memory.
void writePlanner(const Campaign& campaign, const CampaignCell& cell, const RunSource& runs,
                  const LoggedPlanner& planner, std::ostream& out) {
  out << planner.name << '\n' << planner.settings.size() << " common properties\n";
  for (const auto& [name, value] : planner.settings) out << name << " = " << value << '\n';
  out << planner.properties.size() << " properties for each run\n";
  for (const std::string& name : planner.properties) out << name << '\n';
  out << cell.runs.size() << " runs\n";
  runs(planner.cell, [&](const BenchmarkRun& run) {
    const auto properties = omplProperties(campaign, cell, run);
    for (const std::string& name : planner.properties) {
      if (const auto value = properties.find(name); value != properties.end()) out << value->second;
      out << "; ";
    }
    out << '\n';
  });
  if (!planner.progressNames
           .empty()) {  // the planner reports progress: write the samples of each run
    out << planner.progressNames.size() << " progress properties for each run\n";
    for (const std::string& name : planner.progressNames) out << name << '\n';
    out << cell.runs.size() << " runs\n";
    runs(planner.cell, [&](const BenchmarkRun& run) {
      for (const auto& sample : run.ompl->progress) {
        for (const auto& [name, value] : sample) out << value << ',';
        out << ';';
      }
      out << '\n';
    });
  }
  out << ".\n";
}

}  // namespace

std::vector<std::string> omplStatusNames() {
  std::vector<std::string> names;
  for (int i = 0; i < ob::PlannerStatus::TYPE_COUNT; ++i)
    names.push_back(ob::PlannerStatus(static_cast<ob::PlannerStatus::StatusType>(i)).asString());
  return names;
}

std::string versionOfOmpl() {
  return std::to_string(OMPL_MAJOR_VERSION) + "." + std::to_string(OMPL_MINOR_VERSION) + "." +
         std::to_string(OMPL_PATCH_VERSION);
}

std::string oneWord(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); }, '_');
  return text;
}

std::map<std::string, std::string> omplProperties(const Campaign& campaign,
                                                  const CampaignCell& cell,
                                                  const BenchmarkRun& run) {
  std::map<std::string, std::string> properties = run.ompl->properties;
  for (const auto& [name, value] : runRow(campaign, cell, run)) {
    if (const auto* yes = std::get_if<bool>(&value))
      properties.emplace(name + " BOOLEAN", *yes ? "1" : "0");
    if (const auto* count = std::get_if<std::uint64_t>(&value))
      properties.emplace(name + " INTEGER", std::to_string(*count));
    if (const auto* number = std::get_if<double>(&value))
      properties.emplace(name + " REAL", shortest(*number));
  }
  for (const char* verdict : {"proved", "refuted", "undecided"})
    if (!run.verdict.empty())
      properties[verdict + std::string(" BOOLEAN")] = run.verdict == verdict ? "1" : "0";
  const CampaignTrajectories& all = campaign.trajectories;
  for (std::size_t set = 0; set < run.trajectories.size(); ++set)
    for (std::size_t maker = 0; maker < run.trajectories[set].makers.size(); ++maker)
      if (const std::string& is = run.trajectories[set].makers[maker].verdict; !is.empty())
        for (const char* verdict : {"proved", "refuted", "undecided"})
          properties[trajectoryPrefix(all, set, maker) + verdict + " BOOLEAN"] =
              is == verdict ? "1" : "0";
  if (run.result == "failed") {
    properties["status ENUM"] = std::to_string(ob::PlannerStatus::CRASH);
    properties["solved BOOLEAN"] = "0";
  }
  return properties;
}

std::string omplExperimentName(const Campaign& campaign, const CampaignCell& cell) {
  return oneWord(campaign.problemNames[cell.problem] + "/" + campaign.variants[cell.variant].name);
}

std::map<std::string, std::string> omplParameters(const Campaign& campaign,
                                                  const CampaignCell& cell) {
  const Variant& variant = campaign.variants[cell.variant];
  CheckerSettings checker = campaign.problems[cell.problem].settings.checker;
  variant.apply(checker);
  std::map<std::string, std::string> parameters;
  parameters["edges TEXT"] = variant.competitor ? variant.competitor->name : wordOf(checker.edges);
  if (checker.edges == EdgeMethod::discrete)
    parameters["resolution REAL"] = shortest(checker.resolution);
  else if (checker.tolerance)
    parameters["tolerance REAL"] = shortest(*checker.tolerance);
  for (const YamlValue::Entry& entry : variant.checker.entries)
    if (entry.key != "edges" && entry.key != "resolution" && entry.key != "tolerance")
      parameters[entry.key + " TEXT"] = entry.value.text;
  return parameters;
}

std::string omplPlannerName(const CampaignCell& cell, const OmplRecord& record) {
  if (cell.planner.label != cell.planner.name) return oneWord(cell.planner.label);
  return record.planner.empty() ? "geometric_" + cell.planner.name : record.planner;
}

std::pair<std::string, std::string> omplSetup(const std::string& setup) {
  const auto planners = setup.find(kPlannersBegin);
  if (planners == std::string::npos) return {setup, ""};
  const auto first = planners + std::string(kPlannersBegin).size();
  return {setup.substr(0, first), setup.substr(first)};
}

void writeOmplLog(const Campaign& campaign, const CampaignResult& result, const RunSource& runs,
                  std::size_t problem, std::size_t variant, std::ostream& out) {
  const CampaignCell any{problem, variant, {}, {}};
  const Problem& p = campaign.problems[problem];
  og::SimpleSetup none(std::make_shared<ob::RealVectorStateSpace>(1));
  Log log(none);
  Benchmark::CompleteExperiment& experiment = log.experiment();
  experiment.name = omplExperimentName(campaign, any);
  experiment.maxTime = campaign.time.value_or(p.settings.planner.time);
  experiment.maxMem = campaign.limits.memory;
  experiment.runCount = static_cast<unsigned>(campaign.runs);
  experiment.startTime = result.start;
  experiment.totalDuration = result.seconds;
  experiment.seed = static_cast<std::uint_fast32_t>(campaign.seed);
  for (const auto& [nameAndType, value] : omplParameters(campaign, any)) {
    const auto blank = nameAndType.rfind(' ');
    log.addExperimentParameter(nameAndType.substr(0, blank), nameAndType.substr(blank + 1), value);
  }
  std::vector<LoggedPlanner> planners;
  for (std::size_t c = 0; c < result.cells.size(); ++c) {
    const CampaignCell& cell = result.cells[c];
    if (cell.problem != problem || cell.variant != variant || cell.runs.empty()) continue;
    LoggedPlanner planner{c, omplPlannerName(cell, {}), {}, {}, {}};
    bool described = false;
    runs(c, [&](const BenchmarkRun& run) {
      for (const auto& [name, value] : omplProperties(campaign, cell, run))
        planner.properties.insert(name);
      const OmplRecord& record = *run.ompl;
      if (record.planner.empty()) return;
      planner.name = omplPlannerName(cell, record);
      planner.settings = record.settings;
      if (!record.progressNames.empty()) planner.progressNames = record.progressNames;
      if (described) return;
      described = true;
      const auto [ofProblem, ofPlanner] = omplSetup(record.setup);
      experiment.setupInfo += experiment.setupInfo.empty() ? ofProblem + ofPlanner : ofPlanner;
      experiment.host = oneWord(record.host);
      experiment.cpuInfo = record.cpu;
    });
    planners.push_back(std::move(planner));
  }
  experiment.planners.resize(
      planners.size());  // empty: OMPL writes only the head of the log, with the number of planners
  std::ostringstream head;
  log.saveResultsToStream(head);
  std::string text = head.str();
  const std::string last = "\n" + std::to_string(planners.size()) + " planners\n";
  text.erase(text.rfind(last) + last.size());
  // Debian's OMPL 1.5.2 has an empty OMPL_VERSION, so OMPL's readers would take the word "version"
  // as the version number.
  const std::string unversioned = "OMPL version \n";
  if (text.rfind(unversioned, 0) == 0)
    text.replace(0, unversioned.size(), "OMPL version " + versionOfOmpl() + "\n");
  out << text;
  for (const LoggedPlanner& planner : planners)
    writePlanner(campaign, result.cells[planner.cell], runs, planner, out);
}

std::string omplLog(const Campaign& campaign, const CampaignResult& result, std::size_t problem,
                    std::size_t variant) {
  std::ostringstream text;
  writeOmplLog(campaign, result, runsOf(result.cells), problem, variant, text);
  return text.str();
}

}  // namespace corridor
