#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/robot_file.h"

/// Builds the moving and the tested part of a `Problem` from what its files say: the kinematic
/// tree, the configuration space, the bodies, the pairs and the tube.
namespace corridor {

/// Moves the robots into the problem: builds its kinematic tree, its space and the robots' bodies,
/// which take over the shapes of the models. Obstacles are added afterwards. The position
/// coordinates of planar and floating joints get the bounds NaN, which mean "not set yet".
void assembleRobots(std::vector<RobotSetup>& robots, Problem& problem);

/// Adds an obstacle with these shapes, or nothing if there are none.
void addObstacle(Problem& problem, std::string name, std::vector<PlacedShape> shapes);

/// Returns whether the problem has a planar or floating joint, or a rigid robot.
bool hasWholes(const Problem& problem);
/// Returns whether the problem has a single joint (revolute, continuous or prismatic).
bool hasJoints(const Problem& problem);

/// The tracking error that the proof shall cover. Unset values stand for rounding only.
struct TubeSpec {
  std::optional<double> joints;    ///< for each single joint, rad or m
  std::optional<double> position;  ///< for each coordinate of planar and floating joints, m
  std::optional<double> rotation;  ///< for the rotation of planar and floating joints, rad
};
/// Sets `problem.tube` to the larger of `asked` and rounding. Rounding is 2^-40 of the coordinate's
/// range; for a position, of the longest range of its joint's coordinates.
void setTube(const TubeSpec& asked, Problem& problem);

/// Pairs of bodies that may touch, by index.
using AllowedBodies = std::vector<std::array<std::size_t, 2>>;

/// Sets `problem.pairs`. Adds notes on pairs of different robots, or of robot and world, that are
/// not tested because they never move against each other, and on a problem without tested pairs.
/// @throws InputError where the problem has more than 10^7 pairs.
void setPairs(const AllowedBodies& allowed, Problem& problem);

}  // namespace corridor
