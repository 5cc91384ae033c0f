#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace corridor::app {

/// The arguments of `corridor benchmark`.
struct BenchmarkArguments {
  std::vector<std::string>
      files;  ///< a campaign, or problems; with `merge`, folders, or files of runs
  /// The options --variants, --planners and --trajectories, which are illegal with a campaign. Each
  /// string is a comma-separated list. If `variants` or `planners` is empty, the defaults are used.
  std::vector<std::string> variants, planners;
  std::vector<std::string> trajectories;  ///< comma-separated lists; empty: none are made
  std::optional<std::uint64_t> runs, seed;
  std::optional<double> time;        ///< limit of a run, seconds
  std::optional<double> memory;      ///< limit of a run, MB
  std::optional<std::string> shard;  ///< "2/3"
  std::uint64_t jobs = 1;
  std::optional<std::string> output;
  bool cache = false;  ///< whether runs find trees, hulls and grids in the user's cache
  bool resume = false, merge = false, json = false;
};

}  // namespace corridor::app
