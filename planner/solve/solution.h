#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/solve/solve.h"

namespace corridor {

/// A solution file. What `corridor solve -o` writes and `corridor verify` reads: YAML, format
/// corridor-solution-1 (keys in planner/README.md). Metres, radians.
struct Solution {
  std::string problem;  ///< the problem's file, relative to the solution's folder
  std::string digest;   ///< of the problem and all its files; empty: not known (`.path` files)
  std::string space;    ///< "SE2", "SE3", or "": joints
  /// Of each number of a state: its name (ConfigurationSpace::numberNames).
  std::vector<std::string> numbers;
  std::string planner;
  std::uint64_t seed = 0;
  bool certified = false;
  std::string checker;  ///< "certified", or what was asked for instead
  double tolerance = 0, margin = 0;
  Configuration tube;  ///< as Problem::tube
  Path path;
};

Solution makeSolution(const Problem& problem, const SolveReport& report);

/// Numbers with the digits that read back as the same double. The file appears whole or not at all.
/// @throws InputError where it can't be written.
void writeSolution(const Solution& solution, const std::filesystem::path& file);

/// Reads what `writeSolution` wrote, strictly; or an OMPL.app `.path` file: a state a line.
/// @throws InputError with all faults: format, unknown, missing or repeated keys, states that
/// aren't of the problem's space.
Solution readSolution(const std::filesystem::path& file, const ConfigurationSpace& space);

}  // namespace corridor
