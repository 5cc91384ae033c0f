#pragma once

#include <array>
#include <vector>

#include "planner/model/model_builder.h"
#include "planner/problem/robot_file.h"

/// The steps that all readers of problems share: the first and the last steps of making a
/// `Problem`.
namespace corridor {

/// Returns the robot's notes. If joints are held without a value in the robot's file, the last note
/// lists these joints.
std::vector<Note> notesOf(const RobotSetup& setup);

/// Adds the robots to a model, and their notes and files to the source.
void addRobots(std::vector<RobotSetup> robots, ModelBuilder& builder, Source& source);

/// Pairs of bodies that may touch, by index.
using AllowedBodies = std::vector<std::array<std::size_t, 2>>;

/// Completes a problem: excludes the allowed pairs from the tests, and sets the tube. Adds a note
/// if no pair is tested, and one for each obstacle that is far larger than the robots, or far away.
/// @pre everything else in the problem is set.
/// @throws InputError if the problem has more than 10^7 pairs, or a coordinate above 1e100 m.
void finishProblem(const AllowedBodies& allowed, const TubeSpec& tube, Problem& problem);

}  // namespace corridor
