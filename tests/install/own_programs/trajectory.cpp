#include <algorithm>
#include <iostream>
#include <stdexcept>

#include "planner/checker/checker.h"
#include "planner/model/model_builder.h"
#include "planner/trajectory/trajectory_curve.h"
#include "planner/trajectory/trajectory_file.h"

int main(int count, char** arguments) try {
  if (count != 3) throw std::invalid_argument("usage: trajectory ROBOT.urdf TRAJECTORY.csv");
  using namespace corridor;
  const Model model = ModelBuilder()
                          .addRobot(arguments[1])  // a URDF file
                          .addObstacle("post", Cylinder{0.05, 2}, {{0.5, 0, 1}})
                          .build();
  const Checker checker(model);
  // Rows of a CSV file, or a JointTrajectory of ROS or MoveIt.
  TrajectoryRows rows =
      readTrajectory(arguments[2], readMotionText(arguments[2], "a trajectory"), model);
  const RowInterpolation between = interpolationOf(rows, {});  // as the usual controllers do
  const Curve curve = curveOf(rows, model.space, between);
  for (std::size_t k = 0; k < curve.pieces.size(); ++k) {
    const MotionResult result = checker.certifyCurve(curve.pieces[k], true);
    if (result.verdict == MotionVerdict::free) continue;
    const double share = std::max(0.0, result.time);
    std::cout << (result.verdict == MotionVerdict::contact ? "contact" : "undecided") << " at "
              << curve.knots[k] + share * (curve.knots[k + 1] - curve.knots[k]) << "\n";
    return 1;
  }
  std::cout << "free\n";
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 2;
}
