#pragma once

#include <atomic>
#include <ctime>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>

#include "planner/checker/motion_validators.h"
#include "planner/checker/problem_state_space.h"
#include "planner/solve/clearance_targets.h"
#include "planner/solve/planner_factory.h"
#include "planner/solve/simplify_path.h"
#include "planner/solve/solve.h"

namespace corridor {

/// A stopwatch of wall time and of processor time (all threads), which can be paused.
class SolveClock {
 public:
  /// Returns the wall time, seconds. The call is cheap enough for planners to make it in every
  /// step.
  double seconds() const { return wall_ + (running_ ? now(CLOCK_MONOTONIC) - wallSince_ : 0); }
  double processorSeconds() const {
    return processor_ + (running_ ? now(CLOCK_PROCESS_CPUTIME_ID) - processorSince_ : 0);
  }
  void pause() {
    wall_ = seconds();
    processor_ = processorSeconds();
    running_ = false;
  }
  void resume() {
    wallSince_ = now(CLOCK_MONOTONIC);
    processorSince_ = now(CLOCK_PROCESS_CPUTIME_ID);
    running_ = true;
  }

 private:
  static double now(clockid_t clock) {
    timespec t{};
    clock_gettime(clock, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }

  double wall_ = 0, processor_ = 0;  // up to the last pause
  double wallSince_ = now(CLOCK_MONOTONIC), processorSince_ = now(CLOCK_PROCESS_CPUTIME_ID);
  bool running_ = true;
};

/// The steps of `solveProblem`, for a caller that does other work between them: planner/benchmark
/// lets OMPL's Benchmark call `plan`. Call setUp, setUpEnds and plan once each, in this order.
/// Between these calls the clock may be paused, so that the caller's own work is not counted.
class SolveRun {
 public:
  /// Both arguments must outlive the object.
  SolveRun(const Problem& problem, const SolveOptions& options);

  /// Sets up space, checker, sampler, planner and objective, and seeds OMPL's random numbers.
  /// @throws InputError with all faults of names and parameters.
  void setUp();
  /// Sets start and goals. @throws InputError if the start or all goals are not free.
  void setUpEnds();
  /// Plans, simplifies and certifies. The report is complete afterwards.
  /// @param orElse a second condition that ends planning.
  /// @returns the planner's status.
  ompl::base::PlannerStatus plan(const ompl::base::PlannerTerminationCondition& orElse);

  SolveClock& clock() { return clock_; }
  const SolveReport& report() const { return report_; }
  const ompl::base::SpaceInformationPtr& spaceInformation() const { return si_; }
  const ompl::base::ProblemDefinitionPtr& definition() const { return definition_; }
  const ompl::base::PlannerPtr& planner() const { return planner_; }

 private:
  bool discrete() const { return problem_.settings.checker.edges == EdgeMethod::discrete; }
  /// Returns whether the planner's tests are those of our own classes, maybe timed.
  bool testsAreOwn() const { return !options_.adaptChecking || options_.adaptedTestsAreProofs; }
  /// Returns whether the edge tests that the planner uses prove as much as the final certification.
  bool testsAreProofs() const {
    return problem_.settings.checker.edges == EdgeMethod::certified && testsAreOwn();
  }
  bool maximisesClearance() const {
    return problem_.settings.objective == Objective::maxMinClearance;
  }
  /// Returns the fault `text` of a value, at the value's line in the problem's file, or at its
  /// origin (SolveOptions::valueOrigins).
  Fault faultAt(const std::string& place, const std::string& text) const;
  PlannerParameter parameterAt(const std::string& place, const std::string& key = "",
                               const std::string& value = "") const;
  bool interrupted() const { return options_.interrupted && options_.interrupted->load(); }
  void checkEnds();
  void setUpSpace();
  void setUpPlanner();
  bool stopsAtFirst() const;
  std::uint64_t defaultRestart() const;
  ompl::base::PlannerStatus search(const ompl::base::PlannerTerminationCondition& stop);
  void setUpObjective();
  void reportProgress();
  bool endsByTime(double until);
  std::vector<Path> simplified(ompl::geometric::PathGeometric& path);
  Path withClearance(const Path& path, const std::function<bool()>& stop);
  void finish();
  bool certified(const Path& path);
  bool joinsStartAndGoal(const Path& path) const;
  std::string whyNotFound(ompl::base::PlannerStatus status) const;

  const Problem& problem_;
  const SolveOptions& options_;
  SolveClock clock_;
  Checker checker_;
  std::shared_ptr<ProblemStateSpace> space_;
  Configuration start_;
  std::vector<Configuration> goals_, goalSamples_;
  ompl::base::SpaceInformationPtr si_;
  std::shared_ptr<CountingMotionValidator> validator_;
  ompl::base::ProblemDefinitionPtr definition_;
  ompl::base::PlannerPtr planner_;
  std::optional<EdgeMemory> edges_;  // set by `simplified`: the edges tested there
  // Set if a clearance is preferred: the targets, and the edges that keep them.
  std::optional<ClearanceTargets> targets_;
  std::optional<EdgeMemory> onTarget_;
  WhyOffTarget whyOffTarget_ = WhyOffTarget::unknown;
  bool optimises_ = false, restartsItself_ = false;
  std::atomic<bool> endedByTime_ = false;  // set by any thread of the planner
  std::mutex progressMutex_;
  double lastProgress_ = 0;
  SolveReport report_;
};

}  // namespace corridor
