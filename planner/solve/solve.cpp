#include "planner/solve/solve.h"

#include <algorithm>
#include <cmath>
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
#include "collision/core/nearest.h"
#include "planner/checker/problem_goal.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/problem/yaml_reader.h"
#include "planner/solve/endpoint_help.h"
#include "planner/solve/goal.h"
#include "planner/solve/solve_steps.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

/// How many states of a goal region planners get; those with an informed sampler keep an ellipse
/// for each.
constexpr std::size_t kGoalSamples = 32;
/// Of planner.time: what simplifying gets where the planner used all of it.
constexpr double kSimplifyShare = 0.05;
constexpr double kProgressPeriod = 0.1;  // s
/// Finer steps than this are no use to anyone, and OMPL counts them in 32 bits.
constexpr double kFinestResolution = 1e-9;

/// The length of a path, as the space measures it. OMPL's own throws where its direct sampling of
/// ellipses doesn't know the space; there samples are drawn and those that can't help rejected.
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

/// The longest step of a tree's growth, where all that moves are joints that turn: 0.7 rad in one
/// of them. OMPL's, 20 % of the space's extent, is 3 to 6 rad: such an edge hits something nearly
/// always. Measured on problems of two arms: trees with it take 2 to 15 times as long.
std::optional<double> rangeOfTurns(const ConfigurationSpace& space) {
  double weight = 0;
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind == Coordinate::Kind::rotation || (c.kind == Coordinate::Kind::line && !c.angular))
      return std::nullopt;
    weight = std::max(weight, c.weight);
  }
  return 0.7 * weight;
}

/// What is to be told of the trees: nothing of the default ones.
std::string treesTold(const TreeWords& words) {
  const TreeWords trees = spelledOut(words), usual = spelledOut({trees.volume, "", ""});
  return (trees.volume == spelledOut({}).volume ? "" : ", " + trees.volume) +
         (trees.overlap == usual.overlap ? "" : ", " + trees.overlap);
}

}  // namespace

Solve::Solve(const Problem& problem, const SolveOptions& options)
    : problem_(problem),
      options_(options),
      checker_(problem),
      space_(std::make_shared<ProblemStateSpace>(problem.space)),
      start_(startOf(problem)),
      goals_(goalsOf(problem)) {
  report_.motion = checker_.options();
  report_.seed = problem.seed;
  report_.planner = problem.planner.name;
  report_.checker = problem.checker.edges +
                    (discrete() ? ", resolution " + shortest(problem.checker.resolution) : "") +
                    treesTold(problem.checker.trees());
}

PlannerParameter Solve::parameterAt(const std::string& place, const std::string& key,
                                    const std::string& value) const {
  const auto elsewhere = options_.setElsewhere.find(place);
  if (elsewhere != options_.setElsewhere.end()) return {key, value, elsewhere->second, 0};
  const Fault at = problem_.faultAt(place, "");
  return {key, value, at.file, at.line};
}

void Solve::checkEnds() {
  std::vector<Fault> faults;
  if (const auto why = whyNotFree("start", start_, checker_))
    faults.push_back(problem_.faultAt("start", *why));
  std::vector<std::string> whyNot;
  goalSamples_ = sampleGoals(checker_, kGoalSamples, whyNot);
  for (const std::string& why : whyNot) {
    if (goalSamples_.empty())
      faults.push_back(problem_.faultAt(
          "goal", problem_.goalRegion
                      ? "no free state was found within the goal; its middle: " + why
                      : why));
    else if (!problem_.goalRegion)
      report_.warnings.push_back(problem_.faultAt("goal", why));
  }
  if (!faults.empty()) throw InputError(std::move(faults));
}

void Solve::setUpSpace() {
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

void Solve::setResolution() {
  const double r = problem_.checker.resolution;
  if (!(r >= kFinestResolution && r < 1)) {
    const PlannerParameter at = parameterAt("checker.resolution");
    throw InputError(Fault{at.file, at.line,
                           "checker.resolution: " + shortest(r) + " is not in [" +
                               shortest(kFinestResolution) + ", 1)"});
  }
  space_->setLongestValidSegmentFraction(r);
}

void Solve::setUpPlanner() {
  std::vector<PlannerParameter> parameters;
  for (const auto& [key, value] : problem_.planner.params)
    parameters.push_back(parameterAt("planner.params." + key, key, value));
  planner_ = makePlanner(si_, problem_.planner.name, parameters, parameterAt("planner.name"));
  const bool given = std::any_of(parameters.begin(), parameters.end(),
                                 [](const PlannerParameter& p) { return p.key == "range"; });
  if (const auto range = rangeOfTurns(problem_.space);
      range && !given && planner_->params().hasParam("range"))
    planner_->params().setParam("range", shortest(*range));
  for (const PlannerInfo& info : knownPlanners())
    if (info.name == problem_.planner.name) {
      report_.repeats = info.repeats;
      optimises_ = info.optimises;
    }
}

void Solve::setUp() {
  ompl::msg::noOutputHandler();  // what users need to know is in the report
  ompl::RNG::setSeed(problem_.seed);
  setUpSpace();
  definition_ = std::make_shared<ob::ProblemDefinition>(si_);
  FaultList faults;
  faults.collect([&] { setResolution(); });
  faults.collect([&] { setValidStateSampler(*si_, problem_.sampler, parameterAt("sampler")); });
  si_->setup();
  faults.collect([&] { setUpPlanner(); });
  faults.collect([&] { setUpObjective(); });
  faults.throwIfAny();
}

void Solve::setUpEnds() {
  checkEnds();
  ob::ScopedState<> start(si_);
  space_->write(start_, start.get());
  definition_->addStartState(start);
  definition_->setGoal(std::make_shared<ProblemGoal>(si_, problem_, goalSamples_));
}

void Solve::setUpObjective() {
  const std::string name = problem_.objective.value_or("");
  ob::OptimizationObjectivePtr objective;
  if (name == "mechanical_work") {
    objective = std::make_shared<ob::MechanicalWorkOptimizationObjective>(si_);
  } else if (keepsClear()) {
    objective = std::make_shared<ob::MaximizeMinClearanceObjective>(si_);
  } else if (name == "length" || (planner_ && planner_->getSpecs().optimizingPaths)) {
    objective = std::make_shared<PathLengthObjective>(si_);
  }
  if (!objective) return;
  // Where a problem doesn't say when to stop, planners have rules of their own: PRM stops at the
  // first, PRMstar uses its time.
  const bool first = problem_.planner.stopAtFirst.value_or(name.empty() && !optimises_);
  // A clearance of 0 is none to stop at: every path has it.
  const double threshold = keepsClear() && !(problem_.objectiveThreshold > 0)
                               ? std::numeric_limits<double>::infinity()
                               : problem_.objectiveThreshold;
  objective->setCostThreshold(first ? objective->infiniteCost() : ob::Cost(threshold));
  definition_->setOptimizationObjective(objective);
}

void Solve::tellProgress() {
  if (!options_.progress) return;
  const std::unique_lock lock(progressMutex_, std::try_to_lock);
  if (!lock || clock_.seconds() < progressTold_ + kProgressPeriod) return;
  progressTold_ = clock_.seconds();
  options_.progress({progressTold_, validator_->checkedMotions()});
}

std::string Solve::whyNotFound(ob::PlannerStatus status) const {
  const Counters counters = checker_.counters();
  std::string text;
  switch (static_cast<ob::PlannerStatus::StatusType>(status)) {
    case ob::PlannerStatus::INVALID_START:
      return "no valid start for " + problem_.planner.name;
    case ob::PlannerStatus::INVALID_GOAL:
      return "no valid goal for " + problem_.planner.name;
    case ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE:
      return problem_.planner.name + " can't use this kind of goal";
    case ob::PlannerStatus::CRASH:
      return problem_.planner.name + " crashed";
    case ob::PlannerStatus::APPROXIMATE_SOLUTION:
      text = "only a path that ends " +
             shortest(std::round(definition_->getSolutionDifference() * 1e4) / 1e4) +
             " from the goal";
      break;
    default:
      text = clock_.seconds() < problem_.planner.time
                 ? problem_.planner.name + " gave up before the time ran out"
                 : "nothing found in the time";
  }
  if (counters.undecided > 0)
    text += "; too close to call: " + std::to_string(counters.undecided) +
            " of the motions, at a tolerance of " + shortest(checker_.options().tolerance) + " m";
  return text + "; more time, another planner or seed may help";
}

ob::PlannerStatus Solve::plan(const ob::PlannerTerminationCondition& orElse) {
  report_.setUpTime = clock_.seconds();
  const double processorBefore = clock_.processorSeconds();
  const double until = problem_.planner.time;
  const ob::PlannerTerminationCondition stop([this, until, &orElse] {
    tellProgress();
    return clock_.seconds() >= until || interrupted() || orElse.eval();
  });
  planner_->setProblemDefinition(definition_);
  planner_->setup();
  const ob::PlannerStatus status = planner_->solve(stop);
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
  report_.time = clock_.seconds();
  report_.processorTime = clock_.processorSeconds();
  report_.searchProcessorTime += report_.processorTime - processorBefore;
  report_.counters = checker_.counters();
  return status;
}

/// The start kept bit for bit and the goal reached, whatever planner and simplifier say of that.
bool Solve::joinsStartAndGoal(const Path& path) const {
  return !path.empty() && path.front() == start_ && inGoal(problem_, goals_, path.back());
}

bool Solve::certified(const Path& path) {
  const double before = clock_.seconds(), processorBefore = clock_.processorSeconds();
  const bool holds = certifiedPath(checker_, path);
  report_.certificationTime += clock_.seconds() - before;
  report_.searchProcessorTime -= clock_.processorSeconds() - processorBefore;  // no search
  return holds;
}

void Solve::finish() {
  // CForest's path is of a space of its own, wrapped around ours; its states are ours.
  og::PathGeometric path(si_);
  for (const ob::State* state :
       definition_->getSolutionPath()->as<og::PathGeometric>()->getStates())
    path.append(state);
  report_.rawStates = path.getStateCount();
  report_.rawLength = lengthOf(problem_.space, readPath(path));
  std::vector<Path> versions;
  if (problem_.simplify && !keepsClear()) {  // shortcuts would cut the corners
    const double until =
        std::max(problem_.planner.time, clock_.seconds() + kSimplifyShare * problem_.planner.time);
    versions =
        simplifiedVersions(si_, path, [&] { return clock_.seconds() >= until || interrupted(); });
  } else {
    versions = {readPath(path)};
  }
  for (std::size_t i = versions.size(); i-- > 0 && report_.outcome != SolveOutcome::solved;) {
    Path states = withShortTurns(problem_.space, versions[i]);
    if (!joinsStartAndGoal(states)) continue;
    if (!discrete() && !certified(states)) continue;
    report_.outcome = SolveOutcome::solved;
    report_.certified = !discrete();
    report_.version = static_cast<int>(i);
    report_.length = lengthOf(problem_.space, states);
    report_.path = std::move(states);
  }
  if (report_.outcome != SolveOutcome::solved)
    report_.why = discrete() ? "a path was found, but it doesn't join start and goal"
                             : "a path was found, but no version of it could be certified as a "
                               "whole, from start to goal";
}

void checkSettings(const Problem& problem) {
  const SolveOptions options;
  Solve(problem, options).setUp();
}

SolveReport solveProblem(const Problem& problem, const SolveOptions& options) {
  Solve solve(problem, options);
  solve.setUp();  // before the checks of start and goal: bad names cost no time
  solve.setUpEnds();
  solve.plan(ob::plannerNonTerminatingCondition());
  return solve.report();
}

}  // namespace corridor
