#pragma once

#include <array>
#include <vector>

#include "planner/model/model_builder.h"
#include "planner/problem/robot_file.h"

/// The first and the last steps of making a `Problem`; all readers of problems share them.
namespace corridor {

/// Returns the robot's notes. If joints are held although the robot's file gives no value for them,
/// the last note lists these joints.
std::vector<Note> notesOf(const RobotSetup& setup);

/// Returns the notes on the robot's mesh files, each with the files. `finishProblem` adds them to a
/// problem's.
std::vector<Note> notesOnMeshes(const RobotDescription& robot);

/// Adds the robots to the model that `builder` makes, and their notes and files to `source`.
void addRobots(std::vector<RobotSetup> robots, ModelBuilder& builder, Source& source);

/// Pairs of bodies that may touch: the indices of the two bodies.
using AllowedBodies = std::vector<std::array<std::size_t, 2>>;

/// Completes a problem: excludes the allowed pairs from the tests, sets the tube, and sets the
/// default limits over time if there are none. Adds notes: a first one if no pair is tested, those
/// of `notesOnReach`, those of the shapes, and one if pairs that were proved never in contact are
/// tested.
/// @pre All other members of the problem are set.
/// @throws InputError if the problem has more than 10^7 pairs, or a coordinate above 1e100 m.
void finishProblem(const AllowedBodies& allowed, const TubeSpec& tube, Problem& problem);

/// Replaces the obstacles of a problem. Everything that `base` says about a pair or a body stays,
/// by the names of the bodies: the pairs that are not tested, with their reasons and proofs, and
/// the paddings. What it says about bodies that the problem does not have is not used, nor are
/// names in a scene's matrix of which `base` had no body. The bounds of rigid robots and of joints
/// stay, even if they were found from the world of `base`.
/// @param base the problem as it was read or built, with its own obstacles. `problem` is a copy of
/// it, perhaps with other settings, start, goals, margin or tube.
/// @param obstacles bodies on frame 0, with the names that `ModelBuilder::addObstacle` takes.
/// @throws InputError as `finishProblem`.
void replaceObstacles(const Problem& base, std::vector<ModelBody> obstacles, Problem& problem);

}  // namespace corridor
