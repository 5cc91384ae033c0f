#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planner/robot/configuration_space.h"
#include "planner/robot/note.h"

namespace corridor {

// In files, states are rows of numbers in the order of the space's `numberNames`, in metres and
// radians.

/// Returns "SE3" (x y z qx qy qz qw) or "SE2" (x y yaw) if a state is one pose: that of a single
/// rigid robot, planar joint or floating joint. The numbers of such a state need no names. Returns
/// "" otherwise.
std::string rigidSpaceOf(const ConfigurationSpace& space);

/// Returns what is wrong with a row (its count of numbers, or a quaternion of zeros), or nullopt.
std::optional<std::string> rowFault(const std::vector<double>& row,
                                    const ConfigurationSpace& space);

/// A state and its line in the file.
struct StateRow {
  int line = 0;  ///< counted from 1
  Configuration q;
};

/// Reads a text file with one state per line, such as OMPL.app's `.path` files. Numbers are
/// separated by blanks or commas, and `#` begins a comment. The first line may be a header: the
/// names of all numbers, in any order. The header may be a comment, as numpy.savetxt writes it. The
/// file may be a pipe; "-" is the standard input.
/// @param notes gets a note on a comment before the first state, since it is not read.
/// @throws InputError with all faults. A file without states is a fault.
std::vector<StateRow> readStateRows(const std::filesystem::path& file,
                                    const ConfigurationSpace& space, std::vector<Note>& notes);

/// An edge and its line in the file.
struct EdgeRow {
  int line = 0;  ///< counted from 1
  Configuration from, to;
};

/// Reads a text file with one edge per line: the numbers of the edge's first state, then the
/// numbers of its last state. The format is that of `readStateRows`, without a header. @throws
/// InputError with all faults. A file without edges is a fault.
std::vector<EdgeRow> readEdgeRows(const std::filesystem::path& file,
                                  const ConfigurationSpace& space, std::vector<Note>& notes);

}  // namespace corridor
