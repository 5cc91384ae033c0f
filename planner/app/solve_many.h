#pragma once

#include <atomic>
#include <vector>

#include "planner/app/problem_list.h"
#include "planner/app/solve_arguments.h"
#include "planner/benchmark/executor.h"

namespace corridor::app {

/// Returns the function with which executors start the solving of a problem. The number of a task
/// is the index of its problem. A task must not be killed after its first message, because it then
/// writes its files.
/// @pre the arguments outlive the result.
TaskStarter solveStarter(const std::vector<ListedProblem>& problems, const SolveArguments& a);

/// Solves several problems, each in a process of its own: a crash costs only its own problem.
/// Prints one line for each problem when it is done, and a table at the end; or prints JSON. The
/// arguments `output` and `picture`, if given, name folders; missing folders are created.
/// @param executor starts tasks by `solveStarter`.
/// @returns the exit status: the worst of all problems.
/// @throws InputError if a folder can't be used.
int solveMany(const std::vector<ListedProblem>& problems, const SolveArguments& a,
              Executor& executor, const std::atomic<bool>& interrupted);

}  // namespace corridor::app
