#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "planner/app/solve_arguments.h"
#include "planner/solve/solve.h"

namespace corridor::app {

/// A problem that `corridor solve` has solved, or has tried to.
struct Solved {
  Problem problem;
  SolveReport report;       ///< of the try that is kept
  double readingTime = 0;   ///< seconds to read the problem's files
  std::uint64_t tries = 1;  ///< number of seeds that were tried
};

/// Returns "solved", "not found", "approximate only" or "interrupted".
const char* nameOf(SolveOutcome outcome);
/// Returns whether the solution or the picture is written to the standard output. Then no report is
/// printed there.
bool printsFile(const SolveArguments& a);
/// Returns "12.34 ms" or "1.234 s".
std::string durationText(double seconds);

/// Prints the report on one problem.
void print(const Solved& result, const std::string& problem, const SolveArguments& a);
/// Returns the report on one problem: an entry of `problems` in `--json`.
nlohmann::ordered_json jsonOf(const Solved& result, const std::string& problem);

}  // namespace corridor::app
