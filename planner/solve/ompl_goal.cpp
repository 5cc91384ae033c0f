#include "planner/solve/ompl_goal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <ompl/base/SpaceInformation.h>

#include "planner/checker/problem_goal.h"
#include "planner/checker/problem_state_space.h"
#include "planner/solve/why_not_free.h"

namespace corridor {

namespace ob = ompl::base;

namespace {

/// The goal region is shrunk by this fraction, which is more than a few roundings. So a state that
/// is inside for the planner is also inside for the verifier, which rounds differently.
constexpr double kShrink = 0x1p-40;
/// The maximum number of random states that are tried for each sample that is wanted. Around most
/// goals, nearly all states are free.
constexpr std::size_t kTriesPerGoal = 20;

double uniform(std::mt19937_64& random, double low, double high) {
  // std::uniform_real_distribution gives different numbers with different standard libraries.
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

Vec3 inUnitBall(std::mt19937_64& random, std::size_t dimension) {
  for (;;) {
    Vec3 v = Vec3::Zero();
    for (std::size_t i = 0; i < dimension; ++i)
      v[static_cast<Eigen::Index>(i)] = uniform(random, -1, 1);
    if (v.squaredNorm() <= 1) return v;
  }
}

Configuration randomNear(const Problem& problem, const Configuration& goal,
                         std::mt19937_64& random) {
  const std::vector<Coordinate>& coordinates = problem.model.space.coordinates();
  const GoalRegion& region = *problem.task.goalRegion;
  Configuration q = goal;
  const auto number = [&](std::size_t coordinate) -> double& {
    return q[static_cast<Eigen::Index>(coordinates[coordinate].first)];
  };
  for (const CoordinateGroup& group : problem.model.space.groups()) {
    if (group.kind == CoordinateGroup::Kind::joints) {
      for (const std::size_t c : group.coordinates)
        number(c) += region.joint * uniform(random, -1, 1);
      continue;
    }
    const std::size_t dimension = group.coordinates.size() - 1;
    const Vec3 shift = region.position * inUnitBall(random, dimension);
    for (std::size_t k = 0; k < dimension; ++k)
      number(group.coordinates[k]) += shift[static_cast<Eigen::Index>(k)];
    if (group.kind == CoordinateGroup::Kind::planar) {
      number(group.coordinates.back()) += region.angle * uniform(random, -1, 1);
      continue;
    }
    const double angle = region.angle * uniform(random, 0, 1);
    const Vec3 axis = inUnitBall(random, 3);
    Eigen::Map<Eigen::Quaterniond> turned(&number(group.coordinates.back()));
    if (axis.squaredNorm() > 0) turned = turned * Eigen::AngleAxisd(angle, axis.normalized());
  }
  problem.model.space.normalise(q);
  return q;
}

}  // namespace

OmplGoal::OmplGoal(const ob::SpaceInformationPtr& si, const Problem& problem,
                   std::vector<Configuration> samples)
    : GoalSampleableRegion(si),
      problem_(problem),
      goals_(goalsOf(problem)),
      samples_(std::move(samples)) {
  // OMPL requires a distance below the threshold: with 0 no state would ever be in the goal.
  setThreshold(
      std::max(problem.task.goalThreshold.value_or(0), std::numeric_limits<double>::epsilon()));
}

double OmplGoal::distanceGoal(const ob::State* state) const {
  const Configuration q = configurationOf(*si_, state);
  if (problem_.task.goalRegion) {
    if (inGoal(problem_, goals_, q, -kShrink)) return 0;
    // The distance of a state outside is at least twice the threshold, so that OMPL does not count
    // the state as inside.
    return std::max(distanceToGoalRegion(problem_, goals_, q), 2 * threshold_);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Configuration& goal : goals_)
    least = std::min(least, problem_.model.space.distance(q, goal));
  return least;
}

void OmplGoal::sampleGoal(ob::State* state) const {
  si_->getStateSpace()->as<ProblemStateSpace>()->write(samples_[next_++ % samples_.size()], state);
}

std::vector<Configuration> sampleGoals(const Problem& problem, const Checker& checker,
                                       std::size_t count, std::vector<std::string>& whyNot) {
  const std::vector<Configuration> goals = goalsOf(problem);
  std::vector<Configuration> found;
  for (std::size_t i = 0; i < goals.size(); ++i) {
    const std::string name =
        goals.size() == 1 ? "goal"
                          : "goal " + std::to_string(i + 1) + " of " + std::to_string(goals.size());
    if (const auto why = whyNotFree(goals[i], checker))
      whyNot.push_back(name + ": " + *why);
    else
      found.push_back(goals[i]);
  }
  if (!problem.task.goalRegion) return found;
  std::mt19937_64 random(problem.settings.seed);
  for (std::size_t tries = 0; tries < kTriesPerGoal * count && found.size() < count; ++tries) {
    Configuration q = randomNear(problem, goals[tries % goals.size()], random);
    if (inGoal(problem, goals, q, -kShrink) && checker.isProvedFree(q))
      found.push_back(std::move(q));
  }
  return found;
}

}  // namespace corridor
