#pragma once

#include <atomic>
#include <string>
#include <vector>

#include <ompl/base/goals/GoalSampleableRegion.h>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"

namespace corridor {

/// The goals of a problem, or the regions around them, as a goal of OMPL. Planners that sample goal
/// states get a finite set of valid states, beginning with the problem's own valid goals. The set
/// is finite because several of OMPL's optimising planners need all of it beforehand. Several
/// threads may use the object at once.
class OmplGoal : public ompl::base::GoalSampleableRegion {
 public:
  /// @param samples see `sampleGoals`; at least one.
  OmplGoal(const ompl::base::SpaceInformationPtr& si, const Problem& problem,
           std::vector<Configuration> samples);

  double distanceGoal(const ompl::base::State* state) const override;
  void sampleGoal(ompl::base::State* state) const override;
  unsigned maxSampleCount() const override { return static_cast<unsigned>(samples_.size()); }

 private:
  const Problem& problem_;
  std::vector<Configuration> goals_, samples_;
  mutable std::atomic<std::size_t> next_ = 0;  // planners with threads share the goal
};

/// Returns valid goal states: all goals of the problem that are valid; and, if the problem has a
/// goal region, random states in this region, until there are `count` states, or until 20·`count`
/// random states were tried. The random states depend on the problem's seed, and are drawn around
/// each goal in turn. Empty if no valid state was found.
/// @param whyNot receives a line for each goal that is not valid.
std::vector<Configuration> sampleGoals(const Problem& problem, const Checker& checker,
                                       std::size_t count, std::vector<std::string>& whyNot);

}  // namespace corridor
