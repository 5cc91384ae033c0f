#pragma once

#include <optional>
#include <string>

#include "planner/solve/solution.h"
#include "planner/trajectory/trajectory_curve.h"

namespace corridor::app {

/// The content of a file that describes a motion. Exactly one of `solution` and `trajectory` is
/// set.
struct MotionFile {
  std::optional<Solution> solution;
  std::optional<TrajectoryRows> trajectory;
  /// The curve between the rows of a trajectory, as the option --between chooses it. Unset: the
  /// default of `interpolationOf`.
  std::optional<RowInterpolation> between;
};

/// Reads a solution, an OMPL.app .path file or a trajectory; "-" is the standard input.
/// @param between the option --between, which is for trajectories only.
/// @throws InputError with all faults.
MotionFile readMotion(const Problem& problem, const std::string& file,
                      const std::optional<std::string>& between);

}  // namespace corridor::app
