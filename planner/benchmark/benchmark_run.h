#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/counters.h"
#include "planner/benchmark/trajectory_run.h"
#include "planner/benchmark/variant.h"
#include "planner/jobs/child_process.h"
#include "planner/solve/finish_path.h"

namespace corridor {

/// The record that OMPL's Benchmark keeps of one run: the fields of OMPL's own structures, as
/// strings.
struct OmplRecord {
  std::string planner;                            ///< "geometric_RRTConnect"
  std::string setup, host, cpu;                   ///< description of the experiment
  std::map<std::string, std::string> settings;    ///< the planner's parameters
  std::map<std::string, std::string> properties;  ///< name and SQL type: "time REAL" → "0.1"
  std::vector<std::string> progressNames;         ///< "best cost REAL", …
  std::vector<std::map<std::string, std::string>> progress;
};

/// Returns a record whose texts are all empty.
const std::shared_ptr<const OmplRecord>& noOmplRecord();

/// One run: one planner on one problem with one variant and one seed. Units: seconds, metres,
/// radians.
struct BenchmarkRun {
  std::uint64_t seed = 0;
  /// What failed: the run ("killed by signal 11 …"), the verifier, or the making of a trajectory.
  /// Empty if nothing failed.
  std::string failure;
  std::string result;  ///< "solved", "not found", "approximate only", or "failed"
  /// One line: why the planner returned no solution. Empty if the run is solved; may be empty if
  /// the run failed (see `failure`).
  std::string why;
  bool solved = false, certified = false;
  /// The verifier's verdict: "proved", "refuted" or "undecided". It is "undecided" also if the
  /// verifier failed. Empty if the run is not solved, or the campaign does not verify paths.
  std::string verdict;
  /// One line: the verifier's first finding. Empty if the path is proved or was not verified.
  std::string finding;
  /// Computed by the verifier, in metres, without subtracting the margin. The whole path, tube
  /// included, is proved to keep a distance of at least `provedClearance`. `closestFound` is the
  /// least distance of a tested pair at the poses that the verifier tested. Both are −1 if no pair
  /// was tested, or the path was not verified.
  double provedClearance = -1, closestFound = -1;

  /// Times of everything that `corridor solve` does except reading files; see SolveReport. `time`
  /// is the sum of setUpTime, plannerTime, simplificationTime and certificationTime.
  /// `processorTime` adds up all threads.
  double time = 0, processorTime = 0;
  double searchProcessorTime = 0;  ///< the part of processorTime in planner and simplifier
  double setUpTime = 0, plannerTime = 0, simplificationTime = 0, certificationTime = 0;
  /// The part of `time` that the planner's and the simplifier's tests of states and motions take,
  /// and the final certification. The tests of start and goals during the set-up are not included.
  double checkingTime = 0;
  double verificationTime = 0;
  /// Numbers of states and of edges that planner and simplifier have tested. `states` includes the
  /// samples of edges.
  std::uint64_t states = 0, edges = 0;
  Counters counters;  ///< counted by Corridor's checker; a competitor's own tests are not counted
  /// Numbers of states of the planner's path and of the returned path.
  std::size_t rawStates = 0, pathStates = 0;
  PathLength rawLength, length;
  /// One entry for each set of limits of the campaign. Empty if the run is not solved, or the
  /// campaign makes no trajectories.
  std::vector<LimitedTrajectories> trajectories;
  /// Never null. If OMPL kept no record, all texts in it are empty. Several runs may share one
  /// record.
  std::shared_ptr<const OmplRecord> ompl = noOmplRecord();
};

/// The trajectories that are made along the path of a run.
struct RunTrajectories {
  std::vector<TrajectoryMaker> makers;  ///< empty: no trajectories
  std::vector<JointLimits> limits;      ///< one for each set of limits, for the run's problem
};

struct BenchmarkLimits {
  /// MB per run, in addition to the memory that the process had when the run began. OMPL stops a
  /// planner at this limit. At 1.5 times this limit, any allocation fails.
  double memory = 4096;
  double patience = 600;  ///< seconds for verifying one path, or for one trajectory
};

/// Sets up a run, without planning, to find its faults. @param valueOrigins has the meaning of
/// SolveOptions::valueOrigins. @throws InputError for the same faults as solveProblem.
void checkRun(const Problem& planned, const std::map<std::string, std::string>& valueOrigins);

/// Runs a planner once under OMPL's Benchmark, in this process: sets up, plans, simplifies and
/// certifies as solveProblem does, with the same random numbers.
/// @param planned the problem with the variant, planner, seed and time of the run.
/// @param digest the problem's digest, for OMPL's record.
/// @param memory the limit at which OMPL stops the planner, MB.
/// @param path receives the path if the run is solved.
/// @throws InputError for the same faults as solveProblem.
BenchmarkRun runUnderOmpl(const Problem& planned, const std::string& digest,
                          const std::optional<BenchmarkCompetitor>& competitor, double memory,
                          Path& path);

/// Verifies a run's path with the independent verifier: sets verdict, finding, verificationTime,
/// provedClearance and closestFound.
/// @param problem the problem as its file has it, without the variant, so that all variants are
/// verified alike.
void verifyRun(const Problem& problem, const Path& path, BenchmarkRun& run);

/// Makes trajectories along a path, verifies them, and adds them to `run.trajectories`. Calls
/// `done` after each trajectory.
/// @param problem the problem as its file has it. Its limits over time are replaced by those of
/// `trajectories`. The problem's own checker proves the trajectories, so the way of making them is
/// the same for all variants.
void runTrajectories(const Problem& problem, const RunTrajectories& trajectories, const Path& path,
                     BenchmarkRun& run, const std::function<void()>& done);

/// Starts to make and verify a run in a process of its own, so that a crash, an endless loop or a
/// lack of memory is a failure of this run only. The process is killed if it has no result of the
/// planner after twice planner.time plus a minute, or if the verification or one trajectory takes
/// longer than `limits.patience`.
/// @param problem the problem as its file has it, for verifying the path; null: the path is not
/// verified.
/// @pre if `problem` is null, `trajectories` has no makers. The preconditions of ChildProcess hold.
ChildProcess startRun(const Problem* problem, const Problem& planned, const std::string& digest,
                      const std::optional<BenchmarkCompetitor>& competitor,
                      const BenchmarkLimits& limits, const RunTrajectories& trajectories = {});
/// Returns the run that `startRun` started. @param end how the run's process ended. Only
/// `end.failure`, the number of messages, and the text of the last message are used.
BenchmarkRun runOf(const ChildEnd& end, std::uint64_t seed,
                   const RunTrajectories& trajectories = {});

}  // namespace corridor
