#include "planner/solve/goal_region.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <ompl/base/SpaceInformation.h>

#include "planner/checker/problem_scene.h"
#include "planner/checker/rigid_state_space.h"

namespace corridor {

namespace ob = ompl::base;

namespace {

/// A planner's state shall also be in the region for who computes that in another way: the region
/// is shrunk by what a few roundings could amount to.
constexpr double kShrink = 0x1p-40;

double uniform(std::mt19937_64& random, double low, double high) {
  // std::uniform_real_distribution differs among libraries; a seed shall not.
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

Vec3 inUnitBall(std::mt19937_64& random, int dimension) {
  for (;;) {
    Vec3 v = Vec3::Zero();
    for (int i = 0; i < dimension; ++i) v[i] = uniform(random, -1, 1);
    if (v.squaredNorm() <= 1) return v;
  }
}

}  // namespace

RigidGoalRegion::RigidGoalRegion(const ob::SpaceInformationPtr& si, const Problem& problem,
                                 std::vector<RigidState> samples)
    : GoalSampleableRegion(si), problem_(problem), samples_(std::move(samples)) {}

double RigidGoalRegion::distanceGoal(const ob::State* state) const {
  const RigidState at = readState(problem_.space, state);
  if (inGoal(problem_, at, -kShrink)) return 0;
  const RigidState middle = goalState(problem_);
  const double away = (at.pose.p - middle.pose.p).norm() - problem_.goalRegion->position;
  const double turned = rotationAngle(problem_.space, middle, at) - problem_.goalRegion->angle;
  const double outside = std::max(away, 0.0) + problem_.rotationWeight * std::max(turned, 0.0);
  return std::max(outside, 2 * threshold_);  // outside is outside
}

void RigidGoalRegion::sampleGoal(ob::State* state) const {
  writeState(problem_.space, samples_[next_++ % samples_.size()], state);
}

std::vector<RigidState> sampleGoalRegion(const Problem& problem, const RigidChecker& checker,
                                         std::size_t count) {
  const RigidState middle = goalState(problem);
  const bool spatial = problem.space == RigidSpace::SE3;
  std::vector<RigidState> found;
  if (checker.certifiedState(middle)) found.push_back(middle);
  std::mt19937_64 random(problem.seed);
  for (std::size_t tries = 0; tries < 20 * count && found.size() < count; ++tries) {
    RigidState state = middle;
    state.pose.p += problem.goalRegion->position * inUnitBall(random, spatial ? 3 : 2);
    if (spatial) {
      const double angle = problem.goalRegion->angle * uniform(random, 0, 1);
      Vec3 axis = inUnitBall(random, 3);
      if (axis.squaredNorm() > 0)
        state.pose.q = state.pose.q * Eigen::AngleAxisd(angle, axis.normalized());
      state.pose.q.normalize();
    } else {
      state.yaw = std::remainder(state.yaw + problem.goalRegion->angle * uniform(random, -1, 1),
                                 2 * std::numbers::pi);
    }
    if (inGoal(problem, state, -kShrink) && checker.certifiedState(state)) found.push_back(state);
  }
  return found;
}

}  // namespace corridor
