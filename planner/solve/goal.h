#pragma once

#include <atomic>
#include <string>
#include <vector>

#include <ompl/base/goals/GoalSampleableRegion.h>

#include "planner/checker/checker.h"

namespace corridor {

/// The goals of a problem, or the regions around them, for OMPL. Planners that ask for goal states
/// get a finite set of valid ones, the goals themselves first: several of OMPL's optimising
/// planners need to know all of them beforehand.
class ProblemGoal : public ompl::base::GoalSampleableRegion {
 public:
  /// @param samples see `sampleGoals`; at least one.
  ProblemGoal(const ompl::base::SpaceInformationPtr& si, const Problem& problem,
              std::vector<Configuration> samples);

  double distanceGoal(const ompl::base::State* state) const override;
  void sampleGoal(ompl::base::State* state) const override;
  unsigned maxSampleCount() const override { return static_cast<unsigned>(samples_.size()); }

 private:
  const Problem& problem_;
  std::vector<Configuration> goals_, samples_;
  mutable std::atomic<std::size_t> next_ = 0;  // planners with threads share the goal
};

/// Valid states of the problem's goals: those of the goals themselves that are valid, and, of a
/// region, up to `count` random ones of the problem's seed, spread evenly over the goals. Empty if
/// none was found. @param whyNot gets a line for each goal that isn't valid.
std::vector<Configuration> sampleGoals(const Checker& checker, std::size_t count,
                                       std::vector<std::string>& whyNot);

}  // namespace corridor
