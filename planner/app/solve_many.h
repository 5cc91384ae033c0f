#pragma once

#include <atomic>
#include <vector>

#include "planner/app/problem_list.h"
#include "planner/app/solve_arguments.h"

namespace corridor::app {

/// Solves several problems, `jobs` at a time, each in a process of its own: a crash costs only its
/// own problem. Prints one line for each problem as it is done, and a table at the end; or JSON.
/// `output` and `picture`, if given, are folders, which are made if necessary.
/// @returns the exit status: the worst of all problems.
/// @throws InputError if a folder can't be used.
int solveMany(const std::vector<ListedProblem>& problems, const SolveArguments& a,
              const std::atomic<bool>& interrupted);

}  // namespace corridor::app
