#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/benchmark/benchmark_run.h"
#include "planner/benchmark/campaign_shard.h"
#include "planner/benchmark/campaign_trajectories.h"

namespace corridor {

/// A planner with its parameters, one of those that a campaign compares.
struct CampaignPlanner {
  /// Its name in the results; by default the planner's name.
  std::string label;
  std::string name;  ///< OMPL's name
  /// Parameters. Unset: the problem's, if this is the problem's own planner; else OMPL's defaults.
  std::optional<std::map<std::string, std::string>> params;
  std::optional<Simplifier> simplify = {};  ///< unset: the campaign's, or the problem's
  /// Where the planner is named, for error messages: "lecture.yaml:5: planners". Empty: the place
  /// of the key or option that names all planners.
  std::string place = {};
};

/// What a benchmark runs: every problem with every variant and every planner, all with the same
/// seeds.
struct Campaign {
  std::string name;  ///< the name of its file; "" for a campaign from the command line
  std::vector<Problem> problems;
  /// The names of the problems in the results, and the problems' digests
  /// (planner/problem/digest.h). `identifyProblems` sets both.
  std::vector<std::string> problemNames, digests;
  std::vector<Variant> variants;
  std::vector<CampaignPlanner> planners;  ///< empty: each problem's own planner
  std::uint64_t runs = 10, seed = 1;      ///< seeds: seed … seed + runs − 1
  std::optional<CampaignShard> shard;     ///< the part of the runs to make; unset: all runs
  std::optional<double> time;             ///< seconds per run; unset: the problem's own limit
  std::optional<Simplifier> simplify;     ///< unset: the problem's own setting
  /// Whether every path is verified. If false, nothing reports which paths are in collision.
  bool verify = true;
  /// Whether the cache was filled before the runs (planner/problem/user_cache.h).
  bool cache = false;
  CampaignTrajectories trajectories;  ///< made along each returned path; only with `verify`
  BenchmarkLimits limits;
  /// For error messages: the places where variants, planners and runs are set ("--planners",
  /// "lecture.yaml:4: planners").
  std::map<std::string, std::string> places;
  std::vector<std::string> notes;  ///< for users: what was left out, and why
};

/// Sets the problems' names in the results, printable and distinct ("plate", "plate-2"), and their
/// digests. Call it immediately after reading the problems, before their files can change.
/// @throws InputError if a file of a problem can't be read.
void identifyProblems(Campaign& campaign);

/// A combination of a problem, a variant and a planner, and its runs.
struct CampaignCell {
  std::size_t problem = 0, variant = 0;  ///< indices
  CampaignPlanner planner;
  std::vector<BenchmarkRun> runs;  ///< ordered by seed; fewer if the cell is not finished
};

/// Returns all cells, without runs, in order of problem, then planner, then variant.
std::vector<CampaignCell> cellsOf(const Campaign& campaign);

/// Returns whether the run of this cell and seed is one of those that the campaign makes: the
/// campaign has the seed, and the run belongs to the campaign's shard (if it has a shard).
/// @param cell the index of a cell in `cellsOf`. @param cells the number of all cells.
bool hasRun(const Campaign& campaign, std::size_t cell, std::size_t cells, std::uint64_t seed);

/// A function that calls `visit` for each run of the cell with index `cell`, in order of seed. The
/// runs have all of their data, texts included.
using RunSource =
    std::function<void(std::size_t cell, const std::function<void(const BenchmarkRun&)>& visit)>;

/// Returns a source of the runs in the cells. @pre the cells outlive the source, and no
/// `RunTrimmer` has removed data from their runs.
RunSource runsOf(const std::vector<CampaignCell>& cells);

struct CampaignResult {
  std::vector<CampaignCell> cells;
  bool interrupted = false;
  std::chrono::system_clock::time_point start;
  double seconds = 0;
};

/// Returns the problem for one run of a cell: with variant, planner, time and seed set.
Problem problemOfRun(const Campaign& campaign, const CampaignCell& cell, std::uint64_t seed);

/// Returns the trajectories that are made along the path of each run of a cell.
RunTrajectories trajectoriesOf(const Campaign& campaign, const CampaignCell& cell);

/// Checks the whole campaign before the first run: names and parameters are valid, and starts and
/// goals are free for every variant. @throws InputError with all faults. Parameters, starts and
/// goals are checked only if there is no other fault.
/// @pre the process has only one thread, since this function forks.
void checkCampaign(const Campaign& campaign);

}  // namespace corridor
