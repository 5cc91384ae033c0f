#include "planner/solve/portfolio.h"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include "planner/checker/problem_state_space.h"
#include "planner/model/model.h"
#include "planner/solve/sliding_connect.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

/// The edges of the first search for a rigid body. Problems that need more profit from sliding.
constexpr std::uint64_t kFirstEdgesOfBodies = 2000;
/// The edges of the shortest run of SlidingConnect.
constexpr std::uint64_t kShortestRun = 8000, kShortestRunOfBodies = 32000;
/// For rigid bodies, RRTConnect gets this fraction of SlidingConnect's edges.
constexpr std::uint64_t kBodyShare = 4;
/// The least number of edges of a turn of RRTConnect: a run of SlidingConnect may end early.
constexpr std::uint64_t kLeastTurn = 1000;

/// Parameters of SlidingConnect: its `turn_weight`, and a factor of its range.
struct Variant {
  double turnWeight, range;
};
/// Bodies in passages that are narrow compared to their size, and bodies that have to turn by
/// little (the distance of the space), each with edges of several lengths.
constexpr Variant kVariants[] = {{1, 1}, {0, 1}, {1, 0.25}};

}  // namespace

std::uint64_t luby(std::uint64_t i) {
  // If i = 2^k − 1, the number is 2^(k−1); otherwise the sequence repeats its beginning.
  for (;;) {
    const auto k = static_cast<unsigned>(std::bit_width(i));
    if (i + 1 == std::uint64_t{1} << k) return std::uint64_t{1} << (k - 1);
    i -= (std::uint64_t{1} << (k - 1)) - 1;
  }
}

Portfolio::Portfolio(const ob::SpaceInformationPtr& si, const Checker* checker)
    : ob::Planner(si, "Portfolio"),
      checker_(checker),
      connect_(std::make_shared<og::RRTConnect>(si)) {
  specs_.recognizedGoal = ob::GOAL_SAMPLEABLE_REGION;
  declareParam<double>("range", this, &Portfolio::setRange, &Portfolio::getRange, "0.:1.:10000.");
  const auto* space = dynamic_cast<const ProblemStateSpace*>(si->getStateSpace().get());
  if (!space) throw std::invalid_argument("Portfolio: the space is no ProblemStateSpace");
  restarts_ = hasSingleJoints(space->configurations());
}

Portfolio::~Portfolio() = default;

void Portfolio::setup() {
  connect_->setRange(range_);
  connect_->setup();
  Planner::setup();
}

void Portfolio::setProblemDefinition(const ob::ProblemDefinitionPtr& definition) {
  Planner::setProblemDefinition(definition);
  connect_->setProblemDefinition(definition);
  if (sliding_) sliding_->setProblemDefinition(definition);
}

void Portfolio::clear() {
  Planner::clear();
  connect_->clear();
  if (sliding_) sliding_->clear();
  turns_ = left_ = limit_ = 0;
}

/// Runs a planner until it tested a number of edges.
template <class Member>
ob::PlannerStatus Portfolio::run(Member& member, std::uint64_t edges,
                                 const ob::PlannerTerminationCondition& stop) {
  const std::uint64_t until = si_->getCheckedMotionCount() + edges;
  return member.solve(ob::PlannerTerminationCondition(
      [&] { return stop.eval() || si_->getCheckedMotionCount() >= until; }));
}

/// Goes on with RRTConnect.
ob::PlannerStatus Portfolio::connect(std::uint64_t edges,
                                     const ob::PlannerTerminationCondition& stop) {
  ob::PlannerStatus status = ob::PlannerStatus::TIMEOUT;
  for (std::uint64_t part; edges > 0; edges -= part) {
    if (restarts_ && left_ == 0) {
      if (limit_ > 0) connect_->clear();  // but its random numbers continue
      left_ = limit_ = limit_ > 0 ? 2 * limit_ : kRestartEdges;
    }
    part = restarts_ ? std::min(left_, edges) : edges;
    status = run(*connect_, part, stop);
    left_ -= restarts_ ? part : 0;
    if (status == ob::PlannerStatus::EXACT_SOLUTION || stop.eval()) break;
  }
  return status;
}

/// Makes the next run of SlidingConnect.
ob::PlannerStatus Portfolio::slide(const ob::PlannerTerminationCondition& stop) {
  const std::uint64_t length = luby(++turns_);
  // The runs of each length take turns between the variants. Those of length 2^j end a block of
  // 2^(j+1) − 1 runs, and there are twice as many of half the length.
  const std::uint64_t j = static_cast<std::uint64_t>(std::bit_width(length)) - 1;
  const Variant& variant = kVariants[((turns_ >> (j + 1)) + j) % std::size(kVariants)];
  if (!sliding_) {
    sliding_ = std::make_shared<SlidingConnect>(si_, checker_);
    sliding_->setProblemDefinition(pdef_);
  }
  sliding_->clear();
  sliding_->setTurnWeight(variant.turnWeight);
  sliding_->setRange(range_ * variant.range);
  sliding_->setRangeFactor(range_ > 0 ? 1 : variant.range);
  if (!sliding_->isSetup()) sliding_->setup();
  return run(*sliding_, length * (restarts_ ? kShortestRun : kShortestRunOfBodies), stop);
}

ob::PlannerStatus Portfolio::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  if (!pdef_->getGoal()->hasType(ob::GOAL_SAMPLEABLE_REGION))
    return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  ob::PlannerStatus status = connect(restarts_ ? kRestartEdges : kFirstEdgesOfBodies, stop);
  const auto goesOn = [&] {
    return (status == ob::PlannerStatus::TIMEOUT ||
            status == ob::PlannerStatus::APPROXIMATE_SOLUTION) &&
           !stop.eval();
  };
  while (goesOn()) {
    const std::uint64_t before = si_->getCheckedMotionCount();
    const ob::PlannerStatus slid = slide(stop);
    if (slid == ob::PlannerStatus::EXACT_SOLUTION) return slid;
    if (stop.eval()) break;
    const std::uint64_t share = restarts_ ? 1 : kBodyShare;
    status = connect(std::max((si_->getCheckedMotionCount() - before) / share, kLeastTurn), stop);
  }
  return status;
}

void Portfolio::getPlannerData(ob::PlannerData& data) const {
  connect_->getPlannerData(data);
}

}  // namespace corridor
