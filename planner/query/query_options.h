#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

/// The options of `corridor query`.
namespace corridor::app {

/// The values of the options. The value of an option that was not given is unset, empty or false.
struct QueryArguments {
  std::string meshA, meshB;
  std::optional<std::string> poses;               ///< a file of poses, one per line
  std::optional<std::string> grid, lower, upper;  ///< "10x10x5", "x,y,z"
  std::optional<std::uint64_t> rotations, seed;   ///< with `grid` only
  std::optional<std::string> savePoses;           ///< with `grid` only: write its poses here
  std::optional<std::string> motions;        ///< instead of poses: a file of motions, one per line
  std::optional<std::string> edges;          ///< with `motions` only: the method; unset: the first
  std::optional<std::string> query, volume;  ///< `query`: with poses only; unset: the first
  std::optional<std::string> fit, overlap, build;  ///< unset: the first that the volume has
  std::optional<std::string> hulls;                ///< query the convex hulls, by this method
  std::vector<std::string> deform;                 ///< further shapes of A, one file per frame
  std::optional<std::string> direction;            ///< "x,y,z", for the depth
  bool coherent = false;                           ///< with `hulls` only: see `queryHulls`
  std::optional<double> tolerance;  ///< metres; for the tolerance query and for motions
  std::uint64_t repeat = 1;
};

/// Declares all options to CLI11. @pre `arguments` outlives `command`.
void declareOptions(CLI::App& command, QueryArguments& arguments);

/// Checks, after parsing, which options are given together, and the names of queries and methods.
/// Names of trees are left to `chosenTrees` (query_trees.h).
/// @throws InputError for the first option that is wrong.
void checkOptions(const CLI::App& command);

}  // namespace corridor::app
