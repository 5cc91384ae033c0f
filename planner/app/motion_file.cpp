#include "planner/app/motion_file.h"

#include <filesystem>

#include "collision/core/error.h"
#include "planner/problem/problem.h"

namespace corridor::app {
namespace {

std::optional<RowInterpolation> betweenNamed(const std::optional<std::string>& name) {
  for (const RowInterpolation between :
       {RowInterpolation::linear, RowInterpolation::cubic, RowInterpolation::quintic})
    if (name == nameOf(between)) return between;
  return std::nullopt;
}

}  // namespace

MotionFile readMotion(const Problem& problem, const std::string& file,
                      const std::optional<std::string>& between) {
  MotionFile motion;
  const ConfigurationSpace& space = problem.model.space;
  if (std::filesystem::path(file).extension() == ".path") {
    motion.solution = readSolution(file, space);
  } else {
    const std::string text = readMotionText(file, "a solution or a trajectory");
    if (trajectoryFormatOf(text) == TrajectoryFormat::solution)
      motion.solution = solutionOf(file, text, space);
    else
      motion.trajectory = readTrajectory(file, text, problem.model);
  }
  if (motion.solution && between)
    throw InputError(Fault{"--between", 0,
                           file + " is a solution, whose edges are linear; --between is for "
                                  "trajectories"});
  motion.between = betweenNamed(between);
  return motion;
}

}  // namespace corridor::app
