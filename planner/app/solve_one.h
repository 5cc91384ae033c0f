#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "planner/app/solve_output.h"

namespace corridor::app {

/// Returns the kind of the file that `--trajectory` names, by its extension. @throws InputError for
/// any other extension.
TrajectoryFileKind trajectoryKindOf(const std::string& file);

/// Solves one problem. If it is solved, writes the files that the arguments name: the solution, the
/// picture, and the trajectory if it is proved. With several tries, each try has a seed of its own,
/// from the problem's seed upwards. The best path is kept: the shortest or the clearest, as
/// `SolveArguments::keep` says.
/// @param beforeWriting called after solving, before a file is written.
/// @throws InputError for bad input, or if a file can't be written.
Solved solveOne(const std::string& file, const SolveArguments& a,
                const std::atomic<bool>& interrupted,
                const std::function<void()>& beforeWriting = {});

}  // namespace corridor::app
