#include "planner/benchmark/benchmark_run.h"

#include <cmath>

#include <ompl/geometric/SimpleSetup.h>
#include <ompl/tools/benchmark/Benchmark.h>

#include "collision/core/shortest.h"
#include "planner/benchmark/checking_tally.h"
#include "planner/benchmark/run_record.h"
#include "planner/jobs/child_process.h"
#include "planner/problem/yaml_reader.h"
#include "planner/solve/solve_run.h"
#include "planner/solve/verify_solution.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

/// Seconds that a run may take beyond twice the planner's time limit. They are for work that
/// doesn't check the clock: the set-up, and some steps of some planners.
constexpr double kPatience = 60;

/// The planner that OMPL's Benchmark runs: it plans, simplifies and certifies as `solve` does.
/// Benchmark's own simplification (Benchmark::Request::simplify) is switched off, because it would
/// replace the planner's path before this code could read it.
class WholeSolve final : public ob::Planner {
 public:
  WholeSolve(SolveRun& solve, const CheckingTally& checking, BenchmarkRun& run)
      : Planner(solve.spaceInformation(), solve.planner()->getName()),
        solve_(solve),
        checking_(checking),
        run_(run) {
    specs_ = solve.planner()->getSpecs();
    params_.include(solve.planner()->params());
    plannerProgressProperties_ = solve.planner()->getPlannerProgressProperties();
  }
  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& stop) override {
    begun_ = true;
    solve_.clock().resume();
    ob::PlannerStatus status = ob::PlannerStatus::CRASH;
    try {
      status = solve_.plan(stop);
    } catch (const std::bad_alloc&) {
      run_.failure = "out of memory";
    } catch (const std::exception& error) {  // Benchmark would only print the exception
      run_.failure = error.what();
    }
    solve_.clock().pause();
    // Read the counters now: OMPL tests the planner's path twice afterwards, to fill its columns.
    run_.checkingTime = checking_.seconds() + solve_.report().certificationTime;
    run_.states = checking_.states;
    run_.edges = checking_.motions;
    return status;
  }
  void getPlannerData(ob::PlannerData& data) const override {
    solve_.planner()->getPlannerData(data);
  }
  bool begun() const { return begun_; }

 private:
  SolveRun& solve_;
  const CheckingTally& checking_;
  BenchmarkRun& run_;
  bool begun_ = false;
};

/// The problem that OMPL's Benchmark gets. The `print` of SimpleSetup would measure the space with
/// thousands of random states and motions. This would take longer than many runs do, be counted as
/// tests, and change the planner's random numbers.
class PlainSetup final : public og::SimpleSetup {
 public:
  PlainSetup(const SolveRun& solve, const Problem& problem, std::string digest)
      : SimpleSetup(solve.spaceInformation()),
        problem_(problem),
        digest_(std::move(digest)),
        checker_(solve.report().checker) {
    getProblemDefinition() = solve.definition();
  }
  void print(std::ostream& out) const override {
    out << "Problem " << problem_.source.file.string() << '\n'
        << "SHA-256 " << digest_ << '\n'
        << "Edges " << checker_ << '\n';
    si_->getStateSpace()->printSettings(out);
  }

 private:
  const Problem& problem_;
  std::string digest_, checker_;
};

const char* resultOf(SolveOutcome outcome) {
  return outcome == SolveOutcome::solved        ? "solved"
         : outcome == SolveOutcome::approximate ? "approximate only"
                                                : "not found";
}

void take(const SolveReport& report, BenchmarkRun& run) {
  run.result = resultOf(report.outcome);
  run.why = report.why;
  run.solved = report.outcome == SolveOutcome::solved;
  run.certified = report.certified;
  run.time = report.time;
  run.processorTime = report.processorTime;
  run.searchProcessorTime = report.searchProcessorTime;
  run.setUpTime = report.setUpTime;
  run.plannerTime = report.planningTime - report.setUpTime;
  run.certificationTime = report.certificationTime;
  run.simplificationTime = report.time - report.planningTime - report.certificationTime;
  run.counters = report.counters;
  run.rawStates = report.rawStates;
  run.rawLength = report.rawLength;
  run.pathStates = report.path.size();
  run.length = report.length;
}

OmplRecord omplRecordOf(const ompl::tools::Benchmark::CompleteExperiment& experiment) {
  const auto& planner = experiment.planners.at(0);
  OmplRecord record{planner.name,
                    experiment.setupInfo,
                    experiment.host,
                    experiment.cpuInfo,
                    planner.common,
                    planner.runs.at(0),
                    {},
                    {}};
  if (!planner.runsProgressData.empty()) {
    record.progressNames = planner.progressPropertyNames;
    record.progress = planner.runsProgressData[0];
  }
  return record;
}

}  // namespace

void checkRun(const Problem& planned, const std::map<std::string, std::string>& valueOrigins) {
  SolveOptions options;
  options.valueOrigins = valueOrigins;
  SolveRun solve(planned, options);
  solve.setUp();
  solve.setUpEnds();
}

BenchmarkRun runUnderOmpl(const Problem& planned, const std::string& digest,
                          const std::optional<BenchmarkCompetitor>& competitor, double memory,
                          Path& path) {
  CheckingTally checking;
  SolveOptions options;
  options.adaptChecking = [&](const ob::SpaceInformationPtr& si, const Checker& checker) {
    if (competitor && competitor->states)
      si->setStateValidityChecker(competitor->states(si, checker));
    if (competitor && competitor->motions) si->setMotionValidator(competitor->motions(si, checker));
    tallyChecks(si, checking);
  };
  options.adaptedTestsAreProofs = !competitor;
  SolveRun solve(planned, options);
  solve.setUp();
  solve.setUpEnds();
  solve.clock().pause();

  BenchmarkRun run;
  run.seed = planned.settings.seed;
  PlainSetup setup(solve, planned, digest);
  const auto planner = std::make_shared<WholeSolve>(solve, checking, run);
  setup.setPlanner(planner);
  ompl::tools::Benchmark benchmark(setup, planned.source.name);
  benchmark.addPlanner(planner);
  ompl::tools::Benchmark::Request request;
  request.maxTime = planned.settings.planner.time;
  request.maxMem = memory;
  request.runCount = 1;
  request.displayProgress = request.saveConsoleOutput = request.simplify = false;
  benchmark.benchmark(request);

  take(solve.report(), run);
  // Benchmark plans in a thread of its own. If there is no memory for that thread's stack,
  // Benchmark continues without planning.
  if (!planner->begun()) run.failure = "no memory for the thread that plans";
  if (!run.failure.empty()) run.result = "failed";
  const auto& experiment = benchmark.getRecordedExperimentData();
  if (experiment.planners.empty() || experiment.planners[0].runs.empty())
    throw std::runtime_error("OMPL's Benchmark recorded nothing");
  run.ompl = std::make_shared<const OmplRecord>(omplRecordOf(experiment));
  path = solve.report().path;
  return run;
}

void verifyRun(const Problem& problem, const Path& path, BenchmarkRun& run) {
  Solution solution;
  solution.path = path;
  const SolveClock clock;
  const VerifyReport report = verifySolution(problem, solution);
  run.verificationTime = clock.seconds();
  run.verdict = verdictName(report);
  if (report.verdict != PathVerdict::proved) run.finding = firstFinding(report);
  if (std::isfinite(report.pathReport.closestFound)) {
    run.provedClearance = report.pathReport.provedClearance;
    run.closestFound = report.pathReport.closestFound;
  }
}

void runTrajectories(const Problem& problem, const RunTrajectories& trajectories, const Path& path,
                     BenchmarkRun& run, const std::function<void()>& done) {
  Problem limited = problem;
  const Checker checker(limited);
  for (std::size_t k = 0; k + 1 < path.size(); ++k)
    checker.certifyEdge(path[k], path[k + 1]);  // builds the trees
  for (const JointLimits& limits : trajectories.limits) {
    limited.task.limits = limits;
    const double optimum = optimumAlong(limited, path);
    run.trajectories.push_back({std::isfinite(optimum) ? optimum : 0, {}});
    for (const TrajectoryMaker maker : trajectories.makers) {
      run.trajectories.back().makers.push_back(runTrajectory(maker, limited, checker, path));
      done();
    }
  }
}

namespace {

/// Returns the seconds that the parent waits for each message of a run: the path, the verdict on
/// the path, and each trajectory.
std::vector<double> patienceOf(const Problem& planned, const BenchmarkLimits& limits,
                               const RunTrajectories& trajectories) {
  std::vector<double> patience{2 * planned.settings.planner.time + kPatience};
  patience.resize(2 + trajectories.limits.size() * trajectories.makers.size(), limits.patience);
  return patience;
}

/// Adds an entry for each trajectory that the process did not reach, with the fault `why`.
void addMissing(std::size_t limitSets, std::size_t makers, const std::string& why,
                BenchmarkRun& run) {
  run.trajectories.resize(limitSets);
  for (LimitedTrajectories& set : run.trajectories)
    while (set.makers.size() < makers) set.makers.emplace_back().fault = why;
}

}  // namespace

ChildProcess startRun(const Problem* problem, const Problem& planned, const std::string& digest,
                      const std::optional<BenchmarkCompetitor>& competitor,
                      const BenchmarkLimits& limits, const RunTrajectories& trajectories) {
  const auto work = [&](const auto& send) {
    Path path;
    BenchmarkRun run = competitor && competitor->run
                           ? competitor->run(planned, limits.memory, path)
                           : runUnderOmpl(planned, digest, competitor, limits.memory, path);
    send(text(run));
    if (run.solved && problem) verifyRun(*problem, path, run);
    send(text(run));
    std::size_t missing = trajectories.limits.size() * trajectories.makers.size();
    if (run.solved && problem && missing > 0)
      runTrajectories(*problem, trajectories, path, run, [&] {
        send(text(run));
        --missing;
      });
    for (; missing > 0; --missing) send(text(run));
  };
  // If a planner checks its termination condition, OMPL stops the planner at limits.memory. The
  // larger limit here is for everything else that a run does.
  return ChildProcess(work, {patienceOf(planned, limits, trajectories),
                             static_cast<std::size_t>(1.5 * limits.memory * 1024 * 1024)});
}

BenchmarkRun runOf(const ChildEnd& end, std::uint64_t seed, const RunTrajectories& trajectories) {
  BenchmarkRun run;
  if (!end.messages.empty()) run = readRun(end.messages.back());
  run.seed = seed;
  if (end.messages.empty()) {
    run.result = "failed";
    run.failure = end.failure;
  } else if (!end.failure.empty() && run.solved && end.messages.size() == 1) {
    run.verdict = "undecided";
    run.failure = "the verifier failed: " + end.failure;
  } else if (!end.failure.empty() && run.solved) {
    run.failure = "a trajectory failed: " + end.failure;
  }
  if (run.solved && !trajectories.makers.empty())
    addMissing(trajectories.limits.size(), trajectories.makers.size(),
               run.failure.empty() ? "" : "not made: " + run.failure, run);
  return run;
}

}  // namespace corridor
