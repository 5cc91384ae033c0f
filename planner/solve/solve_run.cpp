#include "planner/solve/solve_run.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <ompl/base/objectives/MaximizeMinClearanceObjective.h>
#include <ompl/base/objectives/MechanicalWorkOptimizationObjective.h>
#include <ompl/base/objectives/PathLengthOptimizationObjective.h>
#include <ompl/base/samplers/informed/RejectionInfSampler.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include "collision/core/error.h"
#include "collision/core/fault_list.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/checker/enclosed_bodies.h"
#include "planner/checker/problem_goal.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/solve/joints_to_hold.h"
#include "planner/solve/keep_clearance.h"
#include "planner/solve/ompl_goal.h"
#include "planner/solve/portfolio.h"
#include "planner/solve/replan_on_target.h"
#include "planner/solve/simplify_path.h"
#include "planner/solve/why_not_free.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

/// The number of states of a goal region that planners get. It is small, because planners with an
/// informed sampler keep an ellipse for each state.
constexpr std::size_t kGoalSamples = 32;
/// The least share of planner.time that simplifying gets, even if the planner used all of it.
constexpr double kSimplifyShare = 0.05;
constexpr double kProgressPeriod = 0.1;  // s
/// Metres. A preferred clearance of up to kSmallClearance is the target from the beginning.
/// Measured on arms, it is reached nearly everywhere. A larger clearance is approached by doubling,
/// from kSmallClearance or from the clearance divided by kClearanceDivisor, whichever is larger.
constexpr double kSmallClearance = 0.005, kClearanceDivisor = 8;
/// The number of edges that are tested to replan stretches with too little clearance: kReplanEdges,
/// and kReplanShare times those of the search.
constexpr std::uint64_t kReplanEdges = 8000, kReplanShare = 10;

/// Minimises the length of a path in the space's distance. OMPL's own class samples ellipses
/// directly, and throws for spaces in which it can't. For such a space this class samples the whole
/// space and rejects states that can't improve the path.
class PathLengthObjective : public ob::PathLengthOptimizationObjective {
 public:
  using PathLengthOptimizationObjective::PathLengthOptimizationObjective;
  ob::InformedSamplerPtr allocInformedStateSampler(const ob::ProblemDefinitionPtr& definition,
                                                   unsigned tries) const override {
    if (si_->getStateSpace()->getType() == ob::STATE_SPACE_UNKNOWN)
      return std::make_shared<ob::RejectionInfSampler>(definition, tries);
    return PathLengthOptimizationObjective::allocInformedStateSampler(definition, tries);
  }
};

/// Returns the default of the parameter `range` (the longest edge that a tree grows) for a robot
/// that has revolute or continuous joints, with or without slides and a moving base: 0.7 rad in the
/// joint of the largest weight. Otherwise returns nullopt; OMPL's default is then used, 20 % of the
/// space's extent. For arms OMPL's default is 3 to 6 rad, and nearly every edge of that length hits
/// something. Measured on problems of two arms: with OMPL's default, planners that grow trees take
/// 2 to 15 times as long.
std::optional<double> defaultRangeForArms(const ConfigurationSpace& space) {
  std::optional<double> range;
  for (const CoordinateGroup& group : space.groups()) {
    if (group.kind != CoordinateGroup::Kind::joints) continue;
    for (const std::size_t member : group.coordinates) {
      const Coordinate& c = space.coordinates()[member];
      if (c.kind == Coordinate::Kind::circle || c.angular)
        range = std::max(range.value_or(0), 0.7 * c.weight);
    }
  }
  return range;
}

/// Returns the words by which the report describes the kind of bounding-volume trees: ", sphere",
/// ", hull" or ", obb-binary, vertices, gjk, median". Defaults are left out, so the result is ""
/// for the default trees.
std::string treesText(const TreeNames& words) {
  const TreeNames trees = withDefaults(words), usual = withDefaults({trees.volume, "", ""});
  return (trees.volume == withDefaults({}).volume ? "" : ", " + trees.volume) +
         (trees.fit == usual.fit ? "" : ", " + trees.fit) +
         (trees.overlap == usual.overlap ? "" : ", " + trees.overlap) +
         (trees.build == usual.build ? "" : ", " + trees.build);
}

}  // namespace

SolveRun::SolveRun(const Problem& problem, const SolveOptions& options)
    : problem_(problem),
      options_(options),
      checker_(problem, options.earlier),
      space_(std::make_shared<ProblemStateSpace>(problem.model.space)),
      start_(startOf(problem)),
      goals_(goalsOf(problem)) {
  report_.tolerance = checker_.options().tolerance;
  report_.margin = checker_.options().margin;
  report_.seed = problem.settings.seed;
  report_.planner = problem.settings.planner.name;
  report_.checker =
      wordOf(problem.settings.checker.edges) +
      (discrete() ? ", resolution " + shortest(problem.settings.checker.resolution) : "") +
      treesText(problem.settings.checker.trees);
}

Fault SolveRun::faultAt(const std::string& place, const std::string& text) const {
  const auto elsewhere = options_.valueOrigins.find(place);
  if (elsewhere != options_.valueOrigins.end()) return {elsewhere->second, 0, text};
  return problem_.source.faultAt(place, text);
}

PlannerParameter SolveRun::parameterAt(const std::string& place, const std::string& key,
                                       const std::string& value) const {
  const Fault at = faultAt(place, "");
  return {key, value, at.file, at.line};
}

void SolveRun::checkEnds() {
  std::vector<Fault> faults;
  if (const auto why = whyNotFree(start_, checker_))
    faults.push_back(faultAt("start", "start: " + *why));
  // The reason is the same for the goals.
  if (!faults.empty() && !checker_.notFreeAtRest().empty()) throw InputError(std::move(faults));
  std::vector<std::string> whyNot;
  goalSamples_ = sampleGoals(problem_, checker_, kGoalSamples, whyNot);
  for (const std::string& why : whyNot) {
    if (goalSamples_.empty())
      faults.push_back(
          faultAt("goal", problem_.task.goalRegion
                              ? "no free state was found in the goal region; at its middle: " + why
                              : why));
    else if (!problem_.task.goalRegion)
      report_.warnings.push_back(faultAt("goal", why));
  }
  if (!faults.empty()) throw InputError(std::move(faults));
}

void SolveRun::setUpSpace() {
  si_ = std::make_shared<ob::SpaceInformation>(space_);
  if (discrete()) {
    si_->setStateValidityChecker(std::make_shared<ExactStateValidityChecker>(si_, checker_));
    validator_ = std::make_shared<DiscreteMotionValidator>(si_, checker_);
  } else {
    si_->setStateValidityChecker(std::make_shared<CertifiedStateValidityChecker>(si_, checker_));
    validator_ = std::make_shared<CertifiedMotionValidator>(si_, checker_);
  }
  si_->setMotionValidator(validator_);
  if (options_.adaptChecking) options_.adaptChecking(si_, checker_);
}

void SolveRun::setUpPlanner() {
  std::vector<PlannerParameter> parameters;
  for (const auto& [key, value] : problem_.settings.planner.params)
    parameters.push_back(parameterAt("planner.params." + key, key, value));
  planner_ = makePlanner(si_, testsAreOwn() ? &checker_ : nullptr, problem_.settings.planner.name,
                         parameters, parameterAt("planner.name"));
  const bool given = std::any_of(parameters.begin(), parameters.end(),
                                 [](const PlannerParameter& p) { return p.key == "range"; });
  if (const auto range = defaultRangeForArms(problem_.model.space);
      range && !given && planner_->params().hasParam("range"))
    planner_->params().setParam("range", shortest(*range));
  for (const PlannerInfo& info : knownPlanners())
    if (info.name == problem_.settings.planner.name) {
      report_.repeatable = info.repeatable;
      optimises_ = info.optimises;
      restartsItself_ = info.restarts;
    }
}

/// Returns the default of `planner.restart`. Searches for rigid bodies through narrow passages need
/// more edges, and profit from a large tree.
std::uint64_t SolveRun::defaultRestart() const {
  const bool isArm = hasSingleJoints(problem_.model.space);
  return isArm && report_.repeatable && !restartsItself_ ? kRestartEdges : 0;
}

void SolveRun::setUp() {
  ompl::msg::noOutputHandler();  // the report contains what users need
  // Every generator of this run is made after this call, which gives it its seed. (OMPL's error
  // message is about the generators that were made before.) OMPL takes the seed 0 as 1, but only in
  // a process that has made no generator.
  ompl::RNG::setSeed(std::max<std::uint64_t>(problem_.settings.seed, 1));
  setUpSpace();
  definition_ = std::make_shared<ob::ProblemDefinition>(si_);
  FaultList faults;
  space_->setLongestValidSegmentFraction(problem_.settings.checker.resolution);
  setValidStateSampler(*si_, problem_.settings.sampler);
  si_->setup();
  faults.collect([&] { setUpPlanner(); });
  faults.collect([&] { setUpObjective(); });
  faults.throwIfAny();
}

void SolveRun::setUpEnds() {
  checkEnds();
  ob::ScopedState<> start(si_);
  space_->write(start_, start.get());
  start_ = space_->read(start.get());  // as in the path: an angle of π becomes −π
  definition_->addStartState(start);
  definition_->setGoal(std::make_shared<OmplGoal>(si_, problem_, goalSamples_));
  if (!options_.noteLeftOut) return;
  report_.notes = notesOnStart(checker_, start_);
  report_.leftOut = leftOutOf(checker_);
}

bool SolveRun::stopsAtFirst() const {
  return problem_.settings.planner.stopAtFirst.value_or(!problem_.settings.objective &&
                                                        !optimises_);
}

void SolveRun::setUpObjective() {
  const std::optional<Objective>& wanted = problem_.settings.objective;
  ob::OptimizationObjectivePtr objective;
  if (wanted == Objective::mechanicalWork) {
    objective = std::make_shared<ob::MechanicalWorkOptimizationObjective>(si_);
  } else if (maximisesClearance()) {
    objective = std::make_shared<ob::MaximizeMinClearanceObjective>(si_);
  } else if (wanted == Objective::length || (planner_ && planner_->getSpecs().optimizingPaths)) {
    objective = std::make_shared<PathLengthObjective>(si_);
  }
  if (!objective) return;
  // Without `planner.stop`, planning uses all its time if the problem names an objective, or if
  // `knownPlanners` says that the planner optimises. Otherwise it stops at the first solution; this
  // includes PRM, although its specification in OMPL says that it optimises.
  const bool first = stopsAtFirst();
  // Every free path has a clearance of at least 0: with a threshold of 0, planning would stop at
  // the first path.
  const double threshold = maximisesClearance() && !(problem_.settings.objectiveThreshold > 0)
                               ? std::numeric_limits<double>::infinity()
                               : problem_.settings.objectiveThreshold;
  objective->setCostThreshold(first ? objective->infiniteCost() : ob::Cost(threshold));
  definition_->setOptimizationObjective(objective);
}

/// Returns whether the time has run out. If it has, notes that the path depends on the clock
/// (`repeatable`).
bool SolveRun::endsByTime(double until) {
  const bool over = clock_.seconds() >= until;
  if (over) endedByTime_ = true;
  return over;
}

void SolveRun::reportProgress() {
  if (!options_.progress) return;
  const std::unique_lock lock(progressMutex_, std::try_to_lock);
  if (!lock || clock_.seconds() < lastProgress_ + kProgressPeriod) return;
  lastProgress_ = clock_.seconds();
  options_.progress({lastProgress_, validator_->checkedMotions()});
}

std::string SolveRun::whyNotFound(ob::PlannerStatus status) const {
  const Counters counters = checker_.counters();
  std::string text;
  switch (static_cast<ob::PlannerStatus::StatusType>(status)) {
    case ob::PlannerStatus::INVALID_START:
      return "no valid start for " + problem_.settings.planner.name;
    case ob::PlannerStatus::INVALID_GOAL:
      return "no valid goal for " + problem_.settings.planner.name;
    case ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE:
      return problem_.settings.planner.name + " can't use this kind of goal";
    case ob::PlannerStatus::CRASH:
      return problem_.settings.planner.name + " crashed";
    case ob::PlannerStatus::APPROXIMATE_SOLUTION:
      text = std::string(report_.restarts > 0 ? "the best path of the last search"
                                              : "the best path found") +
             " ends " + shortest(std::round(definition_->getSolutionDifference() * 1e4) / 1e4) +
             " from the goal (the planner's distance; see weights)";
      break;
    default:
      text = clock_.seconds() < problem_.settings.planner.time
                 ? problem_.settings.planner.name + " ended before the time ran out"
                 : "no path was found in the time";
  }
  if (counters.undecided > 0)
    text += "; " + std::to_string(counters.undecided) +
            (counters.undecided == 1 ? " edge was" : " edges were") +
            " undecided at a tolerance of " + shortest(checker_.options().tolerance) + " m";
  return text + "; more time, another planner or seed may help";
}

/// Runs the planner. If it tests too many edges without a solution, starts it again.
ob::PlannerStatus SolveRun::search(const ob::PlannerTerminationCondition& stop) {
  // A planner that uses all its time improves its path as long as it can.
  std::uint64_t edges =
      stopsAtFirst() ? problem_.settings.planner.restart.value_or(defaultRestart()) : 0;
  for (std::uint64_t until = 0;; edges *= 2) {
    until += edges;
    const ob::PlannerTerminationCondition enough(
        [&] { return stop.eval() || (edges > 0 && validator_->checkedMotions() >= until); });
    planner_->setProblemDefinition(definition_);
    planner_->setup();
    const ob::PlannerStatus status = planner_->solve(enough);
    if (edges == 0 || definition_->hasExactSolution() || stop.eval() ||
        validator_->checkedMotions() < until)
      return status;
    definition_->clearSolutionPaths();
    planner_->clear();  // but its random numbers continue, so the new search differs
    until = validator_->checkedMotions();
    ++report_.restarts;
  }
}

ob::PlannerStatus SolveRun::plan(const ob::PlannerTerminationCondition& orElse) {
  report_.setUpTime = clock_.seconds();
  const double processorBefore = clock_.processorSeconds();
  const double until = problem_.settings.planner.time;
  const ob::PlannerTerminationCondition stop([this, until, &orElse] {
    reportProgress();
    return endsByTime(until) || interrupted() || orElse.eval();
  });
  const ob::PlannerStatus status = search(stop);
  report_.planningTime = clock_.seconds();
  if (interrupted()) {
    report_.outcome = SolveOutcome::interrupted;
    report_.why = "interrupted";
  } else if (status == ob::PlannerStatus::EXACT_SOLUTION && definition_->hasExactSolution()) {
    finish();
  } else {
    report_.outcome = status == ob::PlannerStatus::APPROXIMATE_SOLUTION ? SolveOutcome::approximate
                                                                        : SolveOutcome::notFound;
    report_.why = whyNotFound(status);
  }
  if (endedByTime_ || interrupted()) report_.repeatable = false;
  report_.time = clock_.seconds();
  report_.processorTime = clock_.processorSeconds();
  report_.searchProcessorTime += report_.processorTime - processorBefore;
  report_.counters = checker_.counters();
  return status;
}

/// Returns whether the path begins at the start, bit for bit, and ends in the goal. This is tested
/// so that the report's promise does not rely on the planner and the simplifier.
bool SolveRun::joinsStartAndGoal(const Path& path) const {
  return !path.empty() && path.front() == start_ && inGoal(problem_, goals_, path.back());
}

bool SolveRun::certified(const Path& path) {
  const double before = clock_.seconds(), processorBefore = clock_.processorSeconds();
  const bool isKnown = edges_ && testsAreProofs();
  const bool holds = isCertified(checker_, path, isKnown ? &*edges_ : nullptr);
  if (holds && targets_) report_.clearance = proveClearance(checker_, *targets_, path, *onTarget_);
  report_.certificationTime += clock_.seconds() - before;
  // `plan` counts the whole of `finish` as search, so the certification is subtracted here.
  report_.searchProcessorTime -= clock_.processorSeconds() - processorBefore;
  return holds;
}

/// Returns the versions of the path in the order in which they are made: the planner's own path,
/// shorter ones, and a version with more clearance, if one is preferred and was found.
std::vector<Path> SolveRun::simplified(og::PathGeometric& path) {
  std::vector<Path> versions{configurationsOf(path)};
  const Simplifier simplifier = problem_.settings.simplify;
  // Shortcuts would reduce the clearance.
  if (simplifier == Simplifier::none || maximisesClearance()) return versions;
  const double until = std::max(problem_.settings.planner.time,
                                clock_.seconds() + kSimplifyShare * problem_.settings.planner.time);
  const auto stop = [&] { return endsByTime(until) || interrupted(); };
  if (simplifier == Simplifier::ompl) {
    simplifyByOmpl(si_, path, stop);
    versions.push_back(configurationsOf(path));
    return versions;
  }
  // Edges are tested by OMPL's validator, since adapted and discrete checkers are behind it.
  edges_.emplace(
      [si = si_, space = space_, from = ob::ScopedState<>(si_), to = ob::ScopedState<>(si_)](
          const Configuration& a, const Configuration& b) mutable {
        space->write(a, from.get());
        space->write(b, to.get());
        return si->checkMotion(from.get(), to.get());
      });
  versions = simplifiedVersions(problem_.model.space, versions.front(), *edges_, stop);
  // Without tested pairs, there are no obstacles to move away from.
  if (preferredClearance(problem_) > 0 && !checker_.scene().pairs().empty()) {
    Path clear = withClearance(versions.back(), stop);
    if (clear != versions.back()) versions.push_back(std::move(clear));
  }
  return versions;
}

Path SolveRun::withClearance(const Path& path, const std::function<bool()>& stop) {
  const ConfigurationSpace& space = problem_.model.space;
  const double clearance = preferredClearance(problem_),
               longest = (1 + problem_.settings.prefer.detour) * distanceAlong(space, path);
  Path clear = path;
  // A large clearance is approached in steps, since a large step away from one obstacle often hits
  // another one.
  for (double part = std::max(clearance / kClearanceDivisor, std::min(clearance, kSmallClearance));;
       part = std::min(2 * part, clearance)) {
    targets_.emplace(checker_, part, path.front(), path.back());
    onTarget_.emplace(
        [this](const Configuration& a, const Configuration& b) { return targets_->areKept(a, b); });
    clear = corridor::withClearance(*targets_, space, clear, longest, *edges_, *onTarget_, stop);
    if (part >= clearance) break;
  }
  const auto& params = problem_.settings.planner.params;
  const auto own = params.find("range");  // OMPL has read it as a number; 0: it chooses one
  const double range = own == params.end() ? 0 : std::strtod(own->second.c_str(), nullptr);
  const ReplanLimits limits{longest, kReplanEdges + kReplanShare * validator_->checkedMotions(),
                            range > 0 ? range : HUGE_VAL, stop};
  ReplannedPath replanned =
      replannedOnTarget(space_, *targets_, clear, *edges_, *onTarget_, limits);
  whyOffTarget_ = replanned.why;
  return std::move(replanned.path);
}

void SolveRun::finish() {
  // CForest's path belongs to a space that wraps our space, but its states belong to our space. So
  // the states are copied into a path of our space.
  og::PathGeometric path(si_);
  for (const ob::State* state :
       definition_->getSolutionPath()->as<og::PathGeometric>()->getStates())
    path.append(state);
  report_.rawStates = path.getStateCount();
  report_.rawLength = lengthOf(problem_.model.space, configurationsOf(path));
  const std::vector<Path> versions = simplified(path);
  for (std::size_t i = versions.size(); i-- > 0 && report_.outcome != SolveOutcome::solved;) {
    Path states = withShortTurns(problem_.model.space, versions[i]);
    if (!joinsStartAndGoal(states)) continue;
    if (!discrete() && !certified(states)) continue;
    report_.outcome = SolveOutcome::solved;
    report_.certified = !discrete();
    report_.version = static_cast<int>(i);
    // The reason is that of the last version.
    if (report_.clearance && report_.clearance->shareOnTarget < 1 && i + 1 == versions.size())
      report_.clearance->why = whyOffTarget_;
    report_.length = lengthOf(problem_.model.space, states);
    report_.path = std::move(states);
    if (options_.noteLeftOut) addAll(notesOnJointsToHold(problem_, report_.path), report_.notes);
  }
  if (report_.outcome != SolveOutcome::solved)
    report_.why = discrete() ? "a path was found, but it doesn't join start and goal"
                             : "a path was found, but no version of it could be certified as a "
                               "whole, from start to goal";
  if (report_.outcome == SolveOutcome::solved && options_.trajectory) {
    const double before = clock_.seconds(), processorBefore = clock_.processorSeconds();
    std::optional<CurveClearance> kept;
    if (report_.clearance && problem_.settings.prefer.clearanceOf == ClearanceOf::trajectory)
      kept.emplace(checker_, *targets_, report_.clearance->proved);
    report_.trajectory = makeTrajectory(
        problem_, checker_, report_.path, *options_.trajectory, [this] { return interrupted(); },
        kept ? &*kept : nullptr);
    report_.trajectoryTime = clock_.seconds() - before;
    report_.searchProcessorTime -= clock_.processorSeconds() - processorBefore;
  }
}

}  // namespace corridor
