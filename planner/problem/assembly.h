#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/robot_file.h"

/// From what the files say to what moves and what is tested.
namespace corridor {

/// Moves the robots into a problem: builds its tree, its space and the robots' bodies, which take
/// the shapes of the models; bodies of the world come later. Line coordinates of planar and
/// floating joints get no bounds yet: NaN.
void assembleRobots(std::vector<RobotSetup>& robots, Problem& problem);

void addObstacle(Problem& problem, std::string name, std::vector<PlacedShape> shapes);

/// Of planar and floating joints and of rigid robots, or of single joints.
bool hasWholes(const Problem& problem);
bool hasJoints(const Problem& problem);

/// The tracking error that the proof is to cover; unset: rounding only.
struct TubeSpec {
  std::optional<double> joints;    ///< of each single joint, rad or m
  std::optional<double> position;  ///< of each coordinate of planar and floating joints, m
  std::optional<double> rotation;  ///< and of their rotation, rad
};
/// Sets `problem.tube`: what is asked for, or where that is less, rounding (2^-40 of the range; of
/// positions, of the longest of their ranges).
void setTube(const TubeSpec& asked, Problem& problem);

/// Bodies that may touch, by index.
using AllowedBodies = std::vector<std::array<std::size_t, 2>>;

/// Sets `problem.pairs`, and notes what is not tested without anybody having said so.
void setPairs(const AllowedBodies& allowed, Problem& problem);

}  // namespace corridor
