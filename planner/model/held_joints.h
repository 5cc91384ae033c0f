#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "planner/model/model.h"

/// Joints that could move, but are held in a problem.
namespace corridor {

/// Returns whether the value of a joint of a robot could change in some problem: the joint is not
/// fixed, its limits are not equal, and if it mimics another joint, that one could move it.
bool couldMove(const RobotDescription& robot, std::size_t joint);

/// Returns the part of each body of a model. Two bodies have the same part if no joint that could
/// move is between them: they are joined by fixed joints, or are bases of robots or obstacles. The
/// part of an obstacle is 0.
/// @pre The robots' `linkFrames` are set.
std::vector<std::size_t> fixedPartsOf(const Model& model);

/// Returns the names of the joints between two bodies that could move, each once. In place of a
/// joint that mimics another one, it has the name of that other joint. In a model of several robots
/// the names have prefixes: "left/elbow".
std::vector<std::string> jointsBetween(const Model& model, std::size_t a, std::size_t b);

/// Returns what can be done about two bodies that are too close in every state: `the joint between
/// them, "elbow", is held; hold it at another value, or add allow: [[hand, table]] if this is
/// intended`.
std::string adviceAtRest(const Model& model, std::size_t a, std::size_t b);

}  // namespace corridor
