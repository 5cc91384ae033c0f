#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "collision/core/counters.h"
#include "collision/core/error.h"
#include "planner/solve/finish_path.h"

namespace corridor {

struct SolveProgress {
  double seconds = 0;
  std::uint64_t edges = 0;  ///< asked for by the planner so far
};

struct SolveOptions {
  /// Called a few times a second while planning, maybe from threads of the planner, never from two
  /// at once.
  std::function<void(const SolveProgress&)> progress;
  /// Where it becomes true, solving ends soon, without a result.
  const std::atomic<bool>* interrupted = nullptr;
  /// For messages: keys of the problem that weren't read from its file, and where they come from
  /// ("planner.name" → "--planner").
  std::map<std::string, std::string> setElsewhere;
  /// Called once the checkers of states and motions are set, before planning: may put others in
  /// their place (planner/benchmark measures peers and times so). Start, goals and the last
  /// certification stay Corridor's.
  std::function<void(const std::shared_ptr<ompl::base::SpaceInformation>&, const Checker&)>
      adaptChecking;
};

enum class SolveOutcome {
  solved,  ///< OMPL calls it exact, and the checker asked for holds for the path as returned
  notFound,
  approximate,  ///< a path that ends elsewhere than in the goal: not a solution, not returned
  interrupted,
};

/// What a solve did. Lengths in metres, times in seconds.
struct SolveReport {
  SolveOutcome outcome = SolveOutcome::notFound;
  std::string why;              ///< where not solved: one line
  std::vector<Fault> warnings;  ///< goals that aren't used, and why, where there are others

  Path path;               ///< where solved: nothing turns more than 90° in a step
  bool certified = false;  ///< every edge of `path` was proved in the last step
  std::string checker;     ///< "certified", "adaptive, sphere", "discrete, resolution 0.01", …
  std::string planner;
  bool repeats =
      true;  ///< the planner gives the same path for the same seed, if time doesn't run out
  std::uint64_t seed = 0;
  double time = 0, planningTime = 0;  ///< all of it; until the planner was done
  double setUpTime = 0;               ///< of these: until the planner began
  double certificationTime = 0;       ///< of `time`: the last step's proofs
  double processorTime = 0;           ///< of all threads, in `time`
  double searchProcessorTime = 0;     ///< of that: planner and simplifier
  Counters counters;                  ///< of everything: states, edges, undecided, N_v, N_p
  PathLength length;
  std::size_t rawStates = 0;  ///< of the planner's own path, before simplifying
  PathLength rawLength;       ///< of that
  int version = 0;            ///< which simplified version is returned; 0: the planner's own
  MotionOptions motion;       ///< tolerance and margin of the proof; its tube is the problem's
};

/// Solves a problem. Start and goals are checked first: one free goal is needed. The last step
/// certifies the final states edge by edge; where one fails, the last version of the path that
/// holds as a whole is returned. Ends within planner.time, but for an edge under way and 5 % for
/// simplifying.
///
/// The same problem and seed give the same path, for planners that repeat (planner/README.md), if
/// the time doesn't run out. OMPL's random numbers hang on one seed a process: don't call this from
/// two threads at once.
/// @throws InputError: start or goal in contact, too close, or out of bounds; unknown planner,
/// parameter or sampler.
SolveReport solveProblem(const Problem& problem, const SolveOptions& options = {});

/// All that solveProblem would find wrong with planner, parameters, sampler, resolution and
/// objective, at once. @throws InputError.
void checkSettings(const Problem& problem);

}  // namespace corridor
