#pragma once

#include <atomic>
#include <vector>

#include <ompl/base/goals/GoalSampleableRegion.h>

#include "planner/checker/rigid_checker.h"

namespace corridor {

/// The goal region of `goal: {within: …}`. Planners that ask for goal states get a finite set of
/// valid ones, the middle first: several of OMPL's optimising planners need to know all of them
/// beforehand.
class RigidGoalRegion : public ompl::base::GoalSampleableRegion {
 public:
  /// @param samples see `sampleGoalRegion`.
  RigidGoalRegion(const ompl::base::SpaceInformationPtr& si, const Problem& problem,
                  std::vector<RigidState> samples);

  double distanceGoal(const ompl::base::State* state) const override;
  void sampleGoal(ompl::base::State* state) const override;
  unsigned maxSampleCount() const override { return static_cast<unsigned>(samples_.size()); }

 private:
  const Problem& problem_;
  std::vector<RigidState> samples_;
  mutable std::atomic<std::size_t> next_ = 0;  // planners with threads share the goal
};

/// Valid states of the problem's goal region: its middle, where valid, and up to `count` random
/// ones of the problem's seed. Empty if none was found.
std::vector<RigidState> sampleGoalRegion(const Problem& problem, const RigidChecker& checker,
                                         std::size_t count);

}  // namespace corridor
