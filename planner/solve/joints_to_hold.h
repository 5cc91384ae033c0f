#pragma once

#include <vector>

#include "planner/problem/problem.h"
#include "planner/robot/note.h"
#include "planner/solve/finish_path.h"

namespace corridor {

/// Returns a note on joints that have one value at the start and at all goals, but move along the
/// path, as fingers and wheels do if the robot's file does not choose the joints that are planned
/// for. There is no note if a file chooses them: by `group`, `joints` or `hold`, or by an SRDF.
/// @param path of the problem's configurations.
std::vector<Note> notesOnJointsToHold(const Problem& problem, const Path& path);

}  // namespace corridor
