#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "planner/benchmark/campaign_yaml.h"

/// Campaigns of many simulated runs, to measure the cost of storing, reading and reporting them.
/// The figures of the runs are random, and the texts of failed runs are constant. All other data is
/// that of one real run of each variant and planner.
namespace corridor::bench {

struct SimulatedSize {
  std::size_t runs = 100'000;  ///< number of runs in all; it is rounded up, so that all cells have
                               ///< equally many runs
  std::size_t problems = 50, variants = 4, planners = 2;
};

/// Writes the files of a campaign: problems of a cube in a hall, in each of which the wall is in
/// another place.
/// @returns the path of the campaign file.
inline std::filesystem::path writeSimulated(const SimulatedSize& size,
                                            const std::filesystem::path& folder) {
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
  };
  std::filesystem::create_directories(folder);
  write("robot.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
  std::string problems, resolutions;
  for (std::size_t p = 1; p <= size.problems; ++p) {
    const std::string name = "hall_" + std::to_string(p);
    const double y = -1 - 0.5 * static_cast<double>(p) / static_cast<double>(size.problems);
    write(name + ".yaml",
          "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.01, 6, 1], at: "
          "[0, " +
              std::to_string(y) +
              ", 0]}\nstart: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, "
              "4]]}\nplanner: {time: 20}\n");
    problems += (p > 1 ? ", " : "") + name + ".yaml";
  }
  for (std::size_t v = 1; v < size.variants; ++v)
    resolutions += (v > 1 ? ", " : "") + std::to_string(0.1 / static_cast<double>(v));
  std::string planners;
  const std::vector<std::string> names{"RRTConnect", "RRT", "KPIECE1", "EST", "SBL", "BKPIECE1"};
  for (std::size_t k = 0; k < size.planners; ++k)
    planners += (k ? ", " : "") + names.at(k % names.size());
  const std::size_t cells = size.problems * size.variants * size.planners;
  write("campaign.yaml", "format: corridor-campaign-1\nproblems: [" + problems + "]\nplanners: [" +
                             planners + "]\ncheckers:\n  certified: {edges: certified}\n" +
                             (resolutions.empty() ? ""
                                                  : "  sampled: {edges: discrete, resolution: [" +
                                                        resolutions + "]}\n") +
                             "runs: " + std::to_string((size.runs + cells - 1) / cells) + "\n");
  return folder / "campaign.yaml";
}

/// Makes runs of a simulated campaign. Each run is a function of the seed of this object, the run's
/// cell and the run's seed.
class SimulatedRuns {
 public:
  /// Makes one real run of each variant and planner of the first problem. @pre the
  /// process has one thread, because it starts child processes.
  SimulatedRuns(const Campaign& campaign, std::uint64_t seed) : seed_(seed) {
    cells_ = cellsOf(campaign);
    for (const CampaignCell& cell : cells_) {
      if (cell.problem > 0) continue;
      ChildProcess real =
          startRun(&campaign.problems[0], problemOfRun(campaign, cell, 1), campaign.digests[0],
                   campaign.variants[cell.variant].competitor, campaign.limits);
      while (!real.poll()) ChildProcess::waitForAny({&real}, 100);
      samples_[{cell.variant, cell.planner.label}] = runOf(real.end(), 1);
    }
  }
  std::size_t cells() const { return cells_.size(); }

  BenchmarkRun run(std::size_t index, std::uint64_t runSeed) {
    const CampaignCell& cell = cells_.at(index);
    std::seed_seq mixed{seed_, std::uint64_t{index}, runSeed};
    std::mt19937_64 random(mixed);
    std::uniform_real_distribution<double> share(0, 1);
    std::lognormal_distribution<double> spread(0, 1), noise(0, 0.2);
    BenchmarkRun run = samples_.at({cell.variant, cell.planner.label});
    run.seed = runSeed;
    const auto large = [&](double scale) {
      return static_cast<std::uint64_t>(scale * spread(random));
    };
    run.states = large(2e3);
    run.edges = large(400);
    run.counters.boxTests = large(3e4);
    run.counters.primitiveTests = large(5e3);
    run.checkingTime = (60e-9 * static_cast<double>(run.counters.boxTests) +
                        150e-9 * static_cast<double>(run.counters.primitiveTests)) *
                       noise(random);
    run.time = run.processorTime = run.checkingTime * (1.2 + 2 * share(random));
    run.closestFound = 0.02 * spread(random);
    run.length.metres = 4 + share(random);
    run.rawLength.metres = run.length.metres * (1 + share(random));
    const double end = share(random);
    if (end < 0.005) {
      const std::string result = "failed", why = "killed by signal 9 (Killed)";
      run = {};
      run.seed = runSeed;
      run.result = result;
      run.failure = why;
    } else if (end < 0.03) {
      run.result = "not found";
      run.why = "no path was found within the time limit of 20 s; the planner's trees have " +
                std::to_string(run.states) + " states";
      run.solved = run.certified = false;
      run.verdict.clear();
      run.closestFound = run.provedClearance = -1;
    } else {
      run.result = "solved";
      run.solved = true;
      run.verdict = cell.variant > 0 && share(random) < 0.2 ? "refuted" : "proved";
      if (run.verdict == "refuted") {
        run.closestFound = 0;
        run.finding = "contact: cube and wall at edge 3, between its states 12 and 13, at " +
                      std::to_string(share(random)) + " of the edge";
      }
    }
    return run;
  }

 private:
  std::uint64_t seed_;
  std::vector<CampaignCell> cells_;
  std::map<std::pair<std::size_t, std::string>, BenchmarkRun> samples_;
};

}  // namespace corridor::bench
