#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/solve/make_trajectory.h"

/// Trajectories along the paths of a benchmark's runs: those of Corridor, and others for
/// comparison. All have the same limits and the same time law, are written as rows in the same way,
/// and are judged by the same verifier.
namespace corridor {

/// How the curve of a trajectory is made along a path.
enum class TrajectoryMaker {
  blends,   ///< Corridor's, with proved curves at corners (`makeTrajectory`)
  stop,     ///< the path's edges: the robot rests at each state where the direction changes
  spline,   ///< the natural cubic spline through the states (natural_spline.h)
  inserted  ///< the spline after states were inserted wherever samples of it touch something
};
const char* nameOf(TrajectoryMaker maker);
/// Returns "blends", "stop", "spline" and "inserted".
const std::vector<std::string>& trajectoryMakerNames();
std::optional<TrajectoryMaker> trajectoryMakerNamed(const std::string& name);

/// Makes a trajectory along a path, and lets the checker prove it. If a trajectory by `blends` or
/// `stop` is not proved, it is made again with a smaller deviation. Splines are made once, since
/// they are not expected to be proved.
/// @returns a result like that of `makeTrajectory`. It has a fault if the path does not move. For
/// the makers of splines, it also has a fault if the configuration space contains rotations in
/// space (of a rigid body or a floating joint): a spline through unit quaternions does not keep
/// their norm.
MadeTrajectory makeBy(TrajectoryMaker maker, const Problem& problem, const Checker& checker,
                      const Path& path);

/// Returns the duration, in seconds, of the fastest time law along a path if the robot need not
/// stop at corners and jerk is not limited. No motion along these edges within the limits is
/// faster. Usually no robot can execute this law, since the velocity jumps at corners. Returns NaN
/// if there is no such law.
double optimumAlong(const Problem& problem, const Path& path);

/// What one maker made along the path of a run. Units: seconds, radians, metres.
struct TrajectoryRun {
  std::string fault;  ///< one line: why there is no trajectory; empty if there is one
  double duration = 0;
  std::size_t rows = 0;
  /// A proved upper bound of the largest share of each kind of limit that the trajectory uses at
  /// any instant. −1: there is no such limit, or the rows don't determine the limited quantity.
  double velocity = -1, acceleration = -1, jerk = -1, link = -1;
  /// A proved upper bound of the largest distance by which a joint leaves its bounds.
  double beyondBounds = 0;
  /// The independent verifier's verdict on the rows as they are written: "proved", "refuted" or
  /// "undecided"; empty without a trajectory.
  std::string verdict;
  /// One line: the verifier's first finding. Empty if the trajectory is proved or was not made.
  std::string finding;
  double makeTime = 0;  ///< to make the trajectory, and to prove it by the checker
  double verifyTime = 0;
};

/// Makes a trajectory and verifies it. @param problem the problem, with the limits of the
/// trajectory. @param checker a checker whose trees should be built already, so that the time to
/// build them is not measured.
TrajectoryRun runTrajectory(TrajectoryMaker maker, const Problem& problem, const Checker& checker,
                            const Path& path);

/// The trajectories of a run with one set of limits.
struct LimitedTrajectories {
  double optimum = 0;                 ///< `optimumAlong`; 0: there is none
  std::vector<TrajectoryRun> makers;  ///< in the order of the makers
};

}  // namespace corridor
