#pragma once

#include <atomic>
#include <vector>

#include "planner/app/problem_list.h"
#include "planner/app/solve_arguments.h"
#include "planner/jobs/executor.h"

namespace corridor::app {

/// Returns the function by which an executor starts a task: a child process that solves the problem
/// whose index is the number of the task, and then further ones. A task must not be killed after
/// its first message, because it then writes its files.
/// @pre `problems` and `a` outlive the result.
TaskStarter solveStarter(const std::vector<ListedProblem>& problems, const SolveArguments& a);

/// Solves several problems in child processes, so that a crash loses the result of one problem
/// only. Prints one line for each problem when it is done, and a table at the end. If
/// `a.json` is set, prints one JSON object at the end instead; if `a.jsonLines` is set, prints a
/// line of JSON for each problem instead; if `a.quiet` is set, prints nothing. `a.output` and
/// `a.picture`, if set, name folders; missing folders are created.
/// @param executor starts tasks by `solveStarter`.
/// @returns the largest exit status of all problems, or `interruptedStatus()` after an interrupt.
/// @throws InputError if a folder can't be used, or if a file that is not a solution would be
/// overwritten.
int solveMany(const std::vector<ListedProblem>& problems, const SolveArguments& a,
              Executor& executor, const std::atomic<bool>& interrupted);

}  // namespace corridor::app
