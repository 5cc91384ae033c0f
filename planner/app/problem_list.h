#pragma once

#include <string>
#include <vector>

namespace corridor::app {

/// A problem that a command is given.
struct ListedProblem {
  std::string file;  ///< as `readProblem` takes it
  std::string name;  ///< different for each problem of the list; for names of files
};

/// Returns the problems that the arguments name:
/// * `SET.json#A-B`: the problems A to B of a set of MotionBenchMaker;
/// * a folder without a problem.yaml: every problem.yaml in the folders directly in it, in the
/// order
///   of their names;
/// * anything else: one problem.
/// @throws InputError for a range that is empty or goes beyond the set.
std::vector<ListedProblem> listProblems(const std::vector<std::string>& arguments);

}  // namespace corridor::app
