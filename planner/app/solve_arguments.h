#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/problem.h"

namespace corridor::app {

/// The arguments of `corridor solve`.
struct SolveArguments {
  std::vector<std::string> problems;
  std::optional<std::string> planner, sampler, stop, edges, simplify, smooth;
  std::optional<double> time, resolution, margin, clearance;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> set;  ///< the planner's parameters, key=value
  std::optional<std::string> output, picture, from, trajectory;
  std::optional<double> rate, deviation, cornerDeviation;
  std::uint64_t jobs = 1, tries = 1;
  std::string keep = "shortest";  ///< keep the try whose path is shortest or clearest
  bool json = false, jsonLines = false, quiet = false, noSimplify = false;
};

/// Replaces settings of the problem by those of the command line.
/// @returns `SolveOptions::valueOrigins`: the keys of the planner's name and parameters that were
/// set, each with its option. @throws InputError for a value that is illegal, or contradicts
/// another one.
std::map<std::string, std::string> applyArguments(const SolveArguments& a, Problem& problem);

}  // namespace corridor::app
