#pragma once

#include <string>
#include <vector>

namespace corridor::app {

/// A problem that a command is given.
struct ListedProblem {
  std::string file;  ///< as `readProblem` takes it
  std::string name;  ///< different for each problem of the list; used in file names
};

/// The problems that a command is given.
struct ProblemList {
  std::vector<ListedProblem> problems;
  /// True if there is more than one argument, or if an argument is a range or a folder of problems.
  /// The form of the results depends on this, not on the number of problems in the range or folder.
  bool several = false;
};

/// Returns the problems that the arguments name:
/// * `SET.json#A-B`: the problems A to B of a set of MotionBenchMaker;
/// * a folder without a problem.yaml, in which some subfolders have a problem.yaml: all of these,
///   sorted;
/// * anything else: one problem.
/// @throws InputError for a range that is empty or goes beyond the set.
ProblemList listProblems(const std::vector<std::string>& arguments);

}  // namespace corridor::app
