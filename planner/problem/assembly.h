#pragma once

#include <array>
#include <vector>

#include "planner/model/model_builder.h"
#include "planner/problem/robot_file.h"

/// What all readers of problems do alike: the first and the last steps of making a `Problem`.
namespace corridor {

/// Adds the robots to a model, and their notes and files to the source.
void addRobots(std::vector<RobotSetup> robots, ModelBuilder& builder, Source& source);

/// Pairs of bodies that may touch, by index.
using AllowedBodies = std::vector<std::array<std::size_t, 2>>;

/// Completes a problem whose other members are set: excludes the allowed pairs, and sets tube and
/// digest. Adds notes on pairs of different robots, or of robot and world, that are not tested
/// because they never move against each other, and on a problem without tested pairs.
/// @throws InputError where the problem has more than 10^7 pairs.
void finishProblem(const AllowedBodies& allowed, const TubeSpec& tube, Problem& problem);

}  // namespace corridor
