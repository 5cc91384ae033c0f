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
                                   verdict, finding, provedClearance, closestFound, time,
                                   processorTime, setUpTime, plannerTime, simplificationTime,
                                   certificationTime, checkingTime, searchProcessorTime,
                                   verificationTime, states, edges, counters, rawStates, pathStates,
                                   rawLength, length)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TrajectoryRun, fault, duration, rows, velocity, acceleration,
                                   jerk, link, beyondBounds, verdict, finding, makeTime, verifyTime)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LimitedTrajectories, optimum, makers)

const std::shared_ptr<const OmplRecord>& noOmplRecord() {
  static const auto none = std::make_shared<const OmplRecord>();
  return none;
}

nlohmann::json jsonOf(const BenchmarkRun& run) {
  nlohmann::json all = run;
  if (!run.trajectories.empty()) all["trajectories"] = run.trajectories;
  all["ompl"] = *run.ompl;
  return all;
}

BenchmarkRun runIn(const nlohmann::json& all) {
  auto run = all.get<BenchmarkRun>();
  if (const auto trajectories = all.find("trajectories"); trajectories != all.end())
    trajectories->get_to(run.trajectories);
  run.ompl = std::make_shared<const OmplRecord>(all.at("ompl").get<OmplRecord>());
  return run;
}

std::string lineOf(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string text(const BenchmarkRun& run) {
  return lineOf(jsonOf(run));
}

BenchmarkRun readRun(const std::string& text) {
  return runIn(nlohmann::json::parse(text));
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
