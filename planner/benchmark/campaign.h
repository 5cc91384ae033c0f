#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planner/benchmark/benchmark_run.h"

namespace corridor {

/// Every problem with every variant and every planner, with the same seeds.
struct Campaign {
  std::vector<Problem> problems;
  std::vector<Variant> variants;
  /// OMPL's names; empty: each problem's own. Where it is not the problem's own, its parameters are
  /// OMPL's defaults.
  std::vector<std::string> planners;
  std::uint64_t runs = 10, seed = 1;  ///< seeds: seed … seed + runs − 1
  std::optional<double> time;         ///< seconds a run; unset: what the problem says
  BenchmarkLimits limits;
};

/// A problem with a variant and a planner.
struct CampaignCell {
  std::size_t problem = 0, variant = 0;  ///< indices
  std::string planner;
  std::vector<BenchmarkRun> runs;  ///< by seed; fewer where interrupted
};

struct CampaignResult {
  std::vector<std::string> names;   ///< of the problems, made different
  std::vector<CampaignCell> cells;  ///< by problem, planner, variant
  bool interrupted = false;
  std::chrono::system_clock::time_point start;
  double seconds = 0;
};

struct CampaignProgress {
  std::uint64_t done = 0, total = 0;  ///< runs
  const std::string& problem;         ///< of the one that begins
  const std::string& variant;
  const std::string& planner;
  std::uint64_t seed;
};

struct CampaignOptions {
  std::function<void(const CampaignProgress&)> progress;
  /// Where it becomes true, the run under way is given up, and the result is what there is.
  const std::atomic<bool>* interrupted = nullptr;
};

/// The problem as one run of a cell has it: variant, planner, time and seed set.
Problem plannedProblem(const Campaign& campaign, const CampaignCell& cell, std::uint64_t seed);

/// Checks all of it before any time is spent: names, parameters, and that starts and goals are free
/// for every variant. @throws InputError with all faults.
/// @pre the caller has one thread.
void checkCampaign(const Campaign& campaign);

/// Runs it, one run after the other, each in a process of its own. Variants take turns seed by
/// seed, so that what else the machine does meets all of them.
/// @pre checkCampaign passed; the caller has one thread.
CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options = {});

}  // namespace corridor
