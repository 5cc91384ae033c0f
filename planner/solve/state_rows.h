#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planner/robot/configuration_space.h"

namespace corridor {

/// States as rows of numbers, in files: in the order of the space's `numberNames`, metres and
/// radians.

/// "SE3" or "SE2" where states are the pose of one thing that moves as a whole (x y z qx qy qz qw,
/// x y yaw), whose numbers need no names; else "".
std::string rigidSpaceOf(const ConfigurationSpace& space);

/// What is wrong with a row (its length, a quaternion of zeros), or nothing.
std::optional<std::string> checkRow(const std::vector<double>& row,
                                    const ConfigurationSpace& space);

struct StateRow {
  int line = 0;  ///< from 1
  Configuration q;
};

/// A text file of states, one a line, blank or comma separated; from `#` on a line is a comment.
/// OMPL.app's `.path` files are such. It may be a pipe; "-" is the standard input.
/// @throws InputError with all faults; a file without states is one.
std::vector<StateRow> readStateRows(const std::filesystem::path& file,
                                    const ConfigurationSpace& space);

}  // namespace corridor
