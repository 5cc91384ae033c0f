#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "planner/app/solve_arguments.h"
#include "planner/solve/solve.h"

namespace corridor::app {

/// Returns a share of at most 1 in per cent, rounded down: "88.4 %".
std::string percent(double share);

/// A problem that `corridor solve` has solved, or has tried to.
struct Solved {
  Problem problem;
  SolveReport report;       ///< of the try that is kept
  double readingTime = 0;   ///< seconds to read the problem's files
  std::uint64_t tries = 1;  ///< number of seeds that were tried
};

/// Returns whether the solution or the picture is written to the standard output. If so, the report
/// is not printed there.
bool printsFile(const SolveArguments& a);
/// Returns "12.34 ms" or "1.234 s".
std::string durationText(double seconds);

/// A phase of `solve`: its key in JSON, and its name.
struct SolvePhase {
  const char* key;
  const char* name;
};
/// The phases in their order. The first one is not part of `SolveReport::time`.
inline constexpr std::array<SolvePhase, 6> kSolvePhases{{{"read_s", "reading"},
                                                         {"set_up_s", "set-up"},
                                                         {"search_s", "search"},
                                                         {"simplify_s", "simplification"},
                                                         {"certify_s", "certification"},
                                                         {"trajectory_s", "trajectory"}}};

/// Prints the report on one problem on stdout, unless `a.quiet` is set. If `printsFile(a)`, prints
/// only the notes, and why the problem is not solved, on stderr.
void print(const Solved& result, const std::string& problem, const SolveArguments& a);
/// Returns the report on one problem: an entry of `problems` in `--json`.
nlohmann::ordered_json jsonOf(const Solved& result, const std::string& problem);
/// Returns the whole output of `--json`. @param problems the list of the objects that `jsonOf`
/// returned.
nlohmann::ordered_json reportJson(const nlohmann::ordered_json& problems);

}  // namespace corridor::app
