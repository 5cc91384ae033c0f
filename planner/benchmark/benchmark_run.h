#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/counters.h"
#include "planner/benchmark/child_process.h"
#include "planner/benchmark/variant.h"
#include "planner/solve/finish_path.h"

namespace corridor {

/// What OMPL's Benchmark recorded of one run: its structures, of plain texts.
struct OmplRecord {
  std::string planner;                            ///< "geometric_RRTConnect"
  std::string setup, host, cpu;                   ///< of the experiment
  std::map<std::string, std::string> settings;    ///< of the planner
  std::map<std::string, std::string> properties;  ///< "time REAL" → "0.1"
  std::vector<std::string> progressNames;         ///< "best cost REAL", …
  std::vector<std::map<std::string, std::string>> progress;
};

/// One planner on one problem with one variant and one seed. Seconds, metres, radians.
struct BenchmarkRun {
  std::uint64_t seed = 0;
  /// What kept the run from its end ("killed by signal 11 …"), or its path from being verified; "":
  /// nothing did.
  std::string failure;
  std::string result;  ///< "solved", "not found", "approximate only", or "failed"
  std::string why;     ///< where not solved: one line
  bool solved = false, certified = false;
  /// The verifier's, where solved: "proved", "refuted", "undecided"; else "".
  std::string verdict;
  std::string finding;  ///< where not proved: the first, one line
  /// The verifier's, metres, margin not taken off: all of the path, tube included, is proved to
  /// keep at least the former; the latter is the least distance that it met. −1: there is none
  /// (nothing in the way, or no verdict).
  double provenClearance = -1, leastDistance = -1;

  /// All that `corridor solve` does but reading files; see SolveReport. `time` is the sum of
  /// setUpTime, plannerTime, simplificationTime and certificationTime.
  double time = 0, processorTime = 0;
  double searchProcessorTime = 0;  ///< of processorTime: planner and simplifier
  double setUpTime = 0, plannerTime = 0, simplificationTime = 0, certificationTime = 0;
  double checkingTime = 0;  ///< of `time` after set-up: in tests of states and motions
  double verificationTime = 0;
  /// What planner and simplifier asked for: states tested, samples of edges included, and edges.
  std::uint64_t states = 0, edges = 0;
  Counters counters;  ///< of Corridor's checker; a peer's own tests aren't counted
  std::size_t rawStates = 0, pathStates = 0;  ///< of the planner's path, and of the one returned
  PathLength rawLength, length;
  OmplRecord ompl;
};

struct BenchmarkLimits {
  double memory = 4096;   ///< MB a run, beyond what reading the problems took
  double patience = 600;  ///< seconds, for verifying a path
};

/// A run as one line of JSON, and back.
std::string text(const BenchmarkRun& run);
BenchmarkRun readRun(const std::string& text);

/// Sets a run up, and no more. @throws InputError as solveProblem.
/// @param setElsewhere as SolveOptions::setElsewhere.
void checkRun(const Problem& planned, const std::map<std::string, std::string>& setElsewhere);

/// Runs a planner once under OMPL's Benchmark, in this process: sets it up, plans, simplifies and
/// certifies as solveProblem does, with the same random numbers.
/// @param planned the problem with the variant, planner, seed and time of the run.
/// @param memory MB, at which OMPL stops the planner.
/// @param path is set where solved.
/// @throws InputError as solveProblem.
BenchmarkRun runUnderOmpl(const Problem& planned, const std::optional<BenchmarkPeer>& peer,
                          double memory, Path& path);

/// Has the independent verifier judge a run's path: sets verdict, finding and verificationTime.
/// @param problem as its file has it: one judge for all variants.
void verifyRun(const Problem& problem, const Path& path, BenchmarkRun& run);

/// Both, in a process of its own: a crash, endless work or a lack of memory there is told as the
/// run's failure. Planning may take twice planner.time and a minute.
/// @pre the caller has one thread.
class RunProcess {
 public:
  /// Begins it. @param problem as its file has it, which judges; null: nobody does.
  RunProcess(const Problem* problem, const Problem& planned,
             const std::optional<BenchmarkPeer>& peer, const BenchmarkLimits& limits);
  ChildProcess& process() { return process_; }
  /// @pre the process is over.
  BenchmarkRun run() const;

 private:
  std::uint64_t seed_;
  ChildProcess process_;
};

}  // namespace corridor
