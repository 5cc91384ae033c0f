#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/solve/make_trajectory.h"

/// Trajectories along the paths of a benchmark's runs: ours, and others for comparison. All have
/// the same limits, the same time law, the same rows and the same verifier.
namespace corridor {

/// How the curve of a trajectory is made along a path.
enum class TrajectoryMaker {
  blends,   ///< ours, with proved curves at corners (`makeTrajectory`)
  stop,     ///< the path's edges: the robot rests at each state where the direction changes
  spline,   ///< the natural cubic spline through the states (natural_spline.h)
  inserted  ///< the spline after states were inserted wherever samples of it touch something
};
const char* nameOf(TrajectoryMaker maker);
/// "blends", "stop", "spline", "inserted"
const std::vector<std::string>& trajectoryMakerNames();
std::optional<TrajectoryMaker> trajectoryMakerNamed(const std::string& name);

/// Makes a trajectory along a path, and lets the checker prove it. Blends and stops are made again
/// with a smaller deviation if they are not proved; splines are made once, since nothing about them
/// is expected to be proved.
/// @returns a result as that of `makeTrajectory`. Splines have a fault if the configuration space
/// has a rotation in space, that of a rigid body or of a floating joint, because a spline through
/// unit quaternions does not keep their norm.
MadeTrajectory makeBy(TrajectoryMaker maker, const Problem& problem, const Checker& checker,
                      const Path& path);

/// Returns the duration of the fastest law along a path, in seconds, if the robot need not stop at
/// corners and jerk is not limited. No motion along these edges is faster. Usually no robot can
/// execute this law, since the velocity jumps at corners. NaN if there is no law.
double optimumAlong(const Problem& problem, const Path& path);

/// What one maker made along the path of a run. Units: seconds, radians, metres.
struct TrajectoryRun {
  std::string fault;  ///< one line: why there is no trajectory; empty if there is one
  double duration = 0;
  std::size_t rows = 0;
  /// The largest share of each limit that is used at any instant, proved. −1: there is no such
  /// limit, or the rows don't determine the limited quantity.
  double velocity = -1, acceleration = -1, jerk = -1, link = -1;
  double beyondBounds = 0;  ///< the largest distance by which a joint leaves its bounds
  /// The independent verifier's verdict on the rows as they are written: "proved", "refuted" or
  /// "undecided"; empty without a trajectory.
  std::string verdict;
  std::string finding;  ///< one line: the verifier's first finding, if it is not proved
  double makeTime = 0;  ///< to make it, and to prove it by the checker
  double verifyTime = 0;
};

/// Makes a trajectory and verifies it. @param problem has the limits. @param checker its trees
/// should be built already, so that the time to build them is not measured.
TrajectoryRun runTrajectory(TrajectoryMaker maker, const Problem& problem, const Checker& checker,
                            const Path& path);

/// The trajectories of a run with one set of limits.
struct LimitedTrajectories {
  double optimum = 0;                 ///< `optimumAlong`; 0: there is none
  std::vector<TrajectoryRun> makers;  ///< in the order of the makers
};

}  // namespace corridor
