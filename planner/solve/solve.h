#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "collision/core/counters.h"
#include "collision/core/error.h"
#include "planner/checker/left_out.h"
#include "planner/problem/problem.h"
#include "planner/solve/finish_path.h"
#include "planner/solve/make_trajectory.h"
#include "planner/solve/prove_clearance.h"

namespace corridor {

/// How far a running solve has got.
struct SolveProgress {
  double seconds = 0;
  std::uint64_t edges = 0;  ///< number of edges tested so far for the planner
};

struct SolveOptions {
  /// Called at most ten times a second while planning. The calls may come from the planner's
  /// threads, but there are never two calls at once.
  std::function<void(const SolveProgress&)> progress;
  /// When this becomes true, solving ends soon, without a result.
  const std::atomic<bool>* interrupted = nullptr;
  /// Whether to find out what the proofs leave out (checker/left_out.h), and to make notes on pairs
  /// of bodies that touch in every state, or are within the margin (checker/fixed_pairs.h).
  bool noteLeftOut = false;
  /// For messages: the origins of values that were not read from the problem's file, by key, such
  /// as "planner.name" → "--planner". The keys are planner.name, planner.params.KEY, start and
  /// goal.
  std::map<std::string, std::string> valueOrigins;
  /// Bodies whose trees are used for the same meshes (`makeScene`).
  std::span<const Body> earlier;
  /// Called once before planning, after the checkers of states and motions were set. It may replace
  /// them: planner/benchmark does so to measure times, and to use competitors. Tests of start and
  /// goals, and the final certification, always use the `Checker`.
  std::function<void(const std::shared_ptr<ompl::base::SpaceInformation>&, const Checker&)>
      adaptChecking;
  /// Whether the planner's edge tests are still those of the `Checker` after `adaptChecking`. If
  /// so, the final certification relies on what these tests proved.
  bool adaptedTestsAreProofs = false;
  /// If set, a trajectory along the path is made, too.
  std::optional<TrajectoryFileKind> trajectory;
};

enum class SolveOutcome {
  solved,  ///< OMPL calls the path exact; the path joins start and goal; its edges are certified,
           ///< except with `discrete` edges
  notFound,
  approximate,  ///< the planner's path ends outside of the goal; it is not returned
  interrupted,
};

/// Returns "solved", "not found", "approximate only" or "interrupted".
const char* nameOf(SolveOutcome outcome);

/// The result of a solve and its costs. Times are in seconds.
struct SolveReport {
  SolveOutcome outcome = SolveOutcome::notFound;
  std::string why;              ///< why not solved, in one line; empty if solved
  std::vector<Fault> warnings;  ///< if only some goals are used: why the others are not
  std::vector<Note> notes;      ///< on still pairs, if `SolveOptions::noteLeftOut` is set
  LeftOut leftOut;              ///< what is not proved; set if `SolveOptions::noteLeftOut` is set

  Path path;  ///< empty unless solved; no rotation by more than 90° between two states
  bool certified = false;  ///< every edge of `path` was proved by the final certification
  std::string checker;     ///< "certified", "adaptive, sphere", "discrete, resolution 0.01", …
  std::string planner;
  /// Whether the same problem and seed give the same path again: the planner is repeatable, and
  /// neither planning nor simplifying ended because the time ran out.
  bool repeatable = true;
  std::uint64_t seed = 0;
  std::uint64_t restarts = 0;         ///< how often the search started again (planner.restart)
  double time = 0, planningTime = 0;  ///< seconds of the whole solve, and until the planner ended
  double setUpTime = 0;               ///< seconds until the planner began
  double certificationTime = 0;       ///< seconds of the final certification
  double trajectoryTime = 0;          ///< seconds in which the trajectory was made and proved
  double processorTime = 0;           ///< processor time of the whole solve, all threads
  double searchProcessorTime = 0;     ///< the part of processorTime in planner and simplifier
  /// Counts of all queries: states, edges, undecided answers, and the numbers N_v and N_p of the
  /// cost model (tests of volumes and of primitives).
  Counters counters;
  PathLength length;
  /// Unset if no clearance is preferred (keep_clearance.h).
  std::optional<PathClearance> clearance;
  std::optional<MadeTrajectory> trajectory;  ///< set if solved and SolveOptions requests it
  std::size_t rawStates = 0;  ///< states of the planner's own path, before simplifying
  PathLength rawLength;       ///< length of the planner's own path
  int version = 0;            ///< index of the simplified version returned; 0: the planner's own
  double tolerance = 0, margin = 0;  ///< of the proof, metres; its tube is the problem's
};

/// Solves a problem: checks start and goals (one free goal is enough), plans, simplifies, and
/// certifies the final path edge by edge. If an edge of that path can't be certified, the latest
/// simplified version of which all edges can be certified is returned. With `discrete` edges
/// nothing is certified.
///
/// Planning ends within planner.time, but an edge test that is running when the time runs out is
/// completed. Simplifying gets the rest of planner.time, but at least 5 % of planner.time. The time
/// of the final certification comes in addition.
///
/// The same problem and seed give the same path if `SolveReport::repeatable` is true. OMPL has one
/// random seed per process: don't call this from two threads at once.
/// @throws InputError for a start or goals that are in contact, too close or out of bounds, and for
/// an unknown planner, parameter or sampler.
SolveReport solveProblem(const Problem& problem, const SolveOptions& options = {});

/// Tests the problem's planner, parameters, sampler, resolution and objective as `solveProblem`
/// does.
/// @throws InputError with all faults.
void checkSettings(const Problem& problem);

}  // namespace corridor
