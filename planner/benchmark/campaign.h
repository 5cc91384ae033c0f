#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/benchmark/benchmark_run.h"

namespace corridor {

/// A planner with its parameters, as a campaign compares it with others.
struct CampaignPlanner {
  std::string label;  ///< what results call it: its name, where nobody said another
  std::string name;   ///< OMPL's
  /// Unset: the problem's, if it is the problem's own planner, else OMPL's defaults.
  std::optional<std::map<std::string, std::string>> params;
  std::string place = {};  ///< for messages: "lecture.yaml:5: planners"; "": as of all planners
};

/// Every problem with every variant and every planner, with the same seeds.
struct Campaign {
  std::string name;  ///< of its file; "" where it came from the command line
  std::vector<Problem> problems;
  std::vector<std::string> problemNames;  ///< what results call them: `nameProblems`
  std::vector<Variant> variants;
  std::vector<CampaignPlanner> planners;  ///< empty: each problem's own
  std::uint64_t runs = 10, seed = 1;      ///< seeds: seed … seed + runs − 1
  std::optional<double> time;             ///< seconds a run; unset: what the problem says
  std::optional<bool> simplify;           ///< unset: what the problem says
  bool verify = true;  ///< has every path judged; else nobody knows which are in collision
  BenchmarkLimits limits;
  /// For messages: what names variants, planners and runs ("--planners", "lecture.yaml:4:
  /// planners").
  std::map<std::string, std::string> places;
  std::vector<std::string> notes;  ///< what was left out, and why
};

/// The problems' names, printable, those of one name told apart: "plate", "plate-2".
void nameProblems(Campaign& campaign);

/// A problem with a variant and a planner.
struct CampaignCell {
  std::size_t problem = 0, variant = 0;  ///< indices
  CampaignPlanner planner;
  std::vector<BenchmarkRun> runs;  ///< by seed; fewer where it isn't finished
};

/// All cells, without a run: by problem, planner, variant.
std::vector<CampaignCell> cellsOf(const Campaign& campaign);

struct CampaignResult {
  std::vector<CampaignCell> cells;
  bool interrupted = false;
  std::chrono::system_clock::time_point start;
  double seconds = 0;
};

/// The problem as one run of a cell has it: variant, planner, time and seed set.
Problem plannedProblem(const Campaign& campaign, const CampaignCell& cell, std::uint64_t seed);

/// Checks all of it before any time is spent: names, parameters, and that starts and goals are free
/// for every variant. @throws InputError with all faults.
/// @pre the caller has one thread.
void checkCampaign(const Campaign& campaign);

}  // namespace corridor
