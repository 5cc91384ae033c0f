#include "planner/benchmark/run_record.h"

#include <nlohmann/json.hpp>

namespace corridor {

static void to_json(nlohmann::json& j, const Counters& c) {
  j = {{"boxTests", c.boxTests},     {"triangleTests", c.primitiveTests},
       {"exactTests", c.exactTests}, {"poses", c.poses},
       {"splits", c.splits},         {"edges", c.edges},
       {"states", c.states},         {"undecided", c.undecided}};
}
static void from_json(const nlohmann::json& j, Counters& c) {
  j.at("boxTests").get_to(c.boxTests);
  j.at("triangleTests").get_to(c.primitiveTests);
  j.at("exactTests").get_to(c.exactTests);
  j.at("poses").get_to(c.poses);
  j.at("splits").get_to(c.splits);
  j.at("edges").get_to(c.edges);
  j.at("states").get_to(c.states);
  j.at("undecided").get_to(c.undecided);
}
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(PathLength, metres, radians)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OmplRecord, planner, setup, host, cpu, settings, properties,
                                   progressNames, progress)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(BenchmarkRun, seed, failure, result, why, solved, certified,
                                   verdict, finding, provenClearance, leastDistance, time,
                                   processorTime, setUpTime, plannerTime, simplificationTime,
                                   certificationTime, checkingTime, searchProcessorTime,
                                   verificationTime, states, edges, counters, rawStates, pathStates,
                                   rawLength, length)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrajectoryRun, fault, duration, rows, velocity, acceleration,
                                   jerk, link, beyondBounds, verdict, finding, makeTime, verifyTime)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LimitedTrajectories, optimum, makers)

namespace {

using nlohmann::json;

std::string lineOf(const json& of) {
  return of.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Returns all of a run except OMPL's record.
json figuresOf(const BenchmarkRun& run) {
  json figures = run;
  if (!run.trajectories.empty()) figures["trajectories"] = run.trajectories;
  return figures;
}

BenchmarkRun runOf(const json& figures) {
  auto run = figures.get<BenchmarkRun>();
  if (const auto trajectories = figures.find("trajectories"); trajectories != figures.end())
    trajectories->get_to(run.trajectories);
  if (const auto ompl = figures.find("ompl"); ompl != figures.end())
    run.ompl = std::make_shared<const OmplRecord>(ompl->get<OmplRecord>());
  return run;
}

}  // namespace

const std::shared_ptr<const OmplRecord>& noOmplRecord() {
  static const auto none = std::make_shared<const OmplRecord>();
  return none;
}

std::string text(const BenchmarkRun& run) {
  json all = figuresOf(run);
  all["ompl"] = *run.ompl;
  return lineOf(all);
}

BenchmarkRun readRun(const std::string& text) {
  return runOf(json::parse(text));
}

RunRecord recordOf(const BenchmarkRun& run) {
  json setup = *run.ompl;
  const json ompl{{"properties", std::move(setup["properties"])},
                  {"progress", std::move(setup["progress"])}};
  setup.erase("properties");
  setup.erase("progress");
  return {lineOf(figuresOf(run)), lineOf(ompl), lineOf(setup)};
}

OmplRecord readSetup(const std::string& setup) {
  json all = json::parse(setup);
  all["properties"] = json::object();
  all["progress"] = json::array();
  return all.get<OmplRecord>();
}

BenchmarkRun readRecord(const std::string& figures, const std::string& ompl,
                        const OmplRecord& setup) {
  const json all = json::parse(figures);
  BenchmarkRun run = runOf(all);
  if (all.contains("ompl")) return run;
  const json ofRun = json::parse(ompl);
  OmplRecord record = setup;
  ofRun.at("properties").get_to(record.properties);
  ofRun.at("progress").get_to(record.progress);
  run.ompl = std::make_shared<const OmplRecord>(std::move(record));
  return run;
}

namespace {

/// Makes a text empty, and frees its memory. (After an assignment of "", the text would keep the
/// memory.)
void release(std::string& text) {
  std::string().swap(text);
}

}  // namespace

void RunTrimmer::trim(BenchmarkRun& run) {
  for (std::string* text : {&run.why, &run.finding}) release(*text);
  for (LimitedTrajectories& set : run.trajectories)
    for (TrajectoryRun& made : set.makers) {
      release(made.finding);
      if (made.fault.empty()) continue;
      release(made.fault);
      made.fault = RunTrimmer::kFault;
    }
  if (run.ompl == noOmplRecord()) return;
  auto& machine = machines_[{run.ompl->host, run.ompl->cpu}];
  if (!machine) {
    OmplRecord record;
    record.host = run.ompl->host;
    record.cpu = run.ompl->cpu;
    machine = std::make_shared<const OmplRecord>(std::move(record));
  }
  run.ompl = machine;
}

}  // namespace corridor
