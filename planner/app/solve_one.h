#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "planner/app/solve_output.h"

namespace corridor::app {

/// Returns the kind of the file that `--trajectory` names, by its extension. @throws InputError
TrajectoryFileKind trajectoryKindOf(const std::string& file);

/// Solves one problem, and writes the solution and the picture that the arguments name. With
/// several tries, each try has a seed of its own, from the problem's seed upwards. The best path is
/// kept: the shortest or the clearest, as `SolveArguments::keep` says.
/// @param beforeWriting called after solving, before a file is written.
/// @throws InputError.
Solved solveOne(const std::string& file, const SolveArguments& a,
                const std::atomic<bool>& interrupted,
                const std::function<void()>& beforeWriting = {});

}  // namespace corridor::app
