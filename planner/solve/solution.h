#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/solve/solve.h"

namespace corridor {

/// The content of a solution file, which `corridor solve -o` writes and `corridor verify` reads:
/// YAML, format corridor-solution-1 (keys in planner/FORMATS.md). Metres, radians.
struct Solution {
  /// The name of the problem's file. In a solution file, this name is relative to the folder of the
  /// solution file.
  std::string problem;
  /// The digest of the problem and all its files; empty: not known (`.path` files).
  std::string digest;
  std::string space;  ///< "SE2" or "SE3"; empty if the states have named joints
  /// The name of each number of a state (ConfigurationSpace::numberNames).
  std::vector<std::string> numbers;
  std::string planner;
  std::uint64_t seed = 0;
  bool certified = false;
  std::string checker;               ///< SolveReport::checker; "unknown" for a `.path` file
  double tolerance = 0, margin = 0;  ///< metres
  double clearance = 0;  ///< proved for all tested pairs (`PathClearance::proved`); 0: not stated
  Configuration tube;    ///< as Task::tube
  Path path;
  std::vector<Note> notes;  ///< on what the reader of a `.path` file did not use
};

/// @param digest the problem's (planner/problem/digest.h), or "".
Solution makeSolution(const Problem& problem, const SolveReport& report, std::string digest = "");

/// Writes a solution file. Numbers have enough digits to read back as the same doubles. The file is
/// written whole or not at all.
/// @throws InputError if it can't be written.
void writeSolution(const Solution& solution, const std::filesystem::path& file);
/// Returns the text that a solution file in the current folder has.
std::string solutionText(const Solution& solution);

/// Returns whether a file begins like a solution file: its first 4 kB contain the line that names
/// the format. Returns false for a file that can't be read, and for a pipe or a device.
bool isSolutionFile(const std::filesystem::path& file);

/// Reads a solution file, or an OMPL.app `.path` file, which has one state per line; "-" is the
/// standard input.
/// @throws InputError with all faults: wrong format; unknown, missing or repeated keys; states of
/// another space.
Solution readSolution(const std::filesystem::path& file, const ConfigurationSpace& space);
/// Reads the text of a solution file. @param file for messages. @throws InputError: as
/// readSolution.
Solution solutionOf(const std::filesystem::path& file, const std::string& text,
                    const ConfigurationSpace& space);

}  // namespace corridor
