/// Measures what a campaign of many runs costs: `campaign_scale_benchmark --out FOLDER [--runs N]
/// [--problems N] [--variants N] [--planners N] [--seed N] [--shards N]`.
///
/// Writes a simulated campaign into the folder (simulated_campaign.h), fills its file of runs
/// `results/runs.jsonl`, and measures:
/// * storing a run, which waits for the disk;
/// * resuming (reading the runs into memory), writing the rows and the database, and writing the
///   report: the time of each, and the largest memory that the process has used by then;
/// * the program itself: `corridor benchmark FOLDER/campaign.yaml -o FOLDER/results --resume`,
///   which has no run to make. With --shards, it only stores the runs, in turn in the files
///   `shard_1/runs.jsonl`, …, which `corridor benchmark --merge` can then merge.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "planner/benchmark/ompl_database.h"
#include "planner/benchmark/report.h"
#include "planner/benchmark/run_file.h"
#include "planner/benchmark/write_reports.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/simulated_campaign.h"

namespace corridor::bench {
namespace {

namespace fs = std::filesystem;
using Mode = RunFile::Mode;

double secondsOf(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Returns the largest memory, in MB, that this process (RUSAGE_SELF) or its largest child process
/// (RUSAGE_CHILDREN) has used so far.
double largestMemory(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void print(const std::string& what, double seconds, double megabytes) {
  std::printf("%-28s %9.1f s %9.0f MB\n", what.c_str(), seconds, megabytes);
  std::fflush(stdout);
}

/// Runs a step in a child process, so that the memory of other steps does not count.
void inFork(const std::function<void()>& step) {
  std::fflush(stdout);
  const pid_t id = ::fork();
  if (id == 0) {
    int status = 0;
    try {
      step();
    } catch (const std::exception& error) {
      std::cerr << error.what() << '\n';
      status = 1;
    }
    std::fflush(stdout);
    ::_exit(status);
  }
  int status = 0;
  if (id < 0 || ::waitpid(id, &status, 0) != id || status != 0)
    throw std::runtime_error("a step failed");
}

/// Stores all runs. With K files, each gets every K-th run, in the order in which a campaign
/// makes its runs.
void store(const Campaign& campaign, SimulatedRuns& simulated, const std::vector<fs::path>& files) {
  const std::uint64_t all = simulated.cells() * campaign.runs;
  double seconds = 0;
  for (std::size_t shard = 0; shard < files.size(); ++shard) {
    fs::create_directories(files[shard].parent_path());
    std::vector<CampaignCell> cells = cellsOf(campaign);
    RunFile stored(files[shard], Mode::fresh, campaign, cells);
    // The order is that of a campaign: all cells with the first seed, then with the second, and so
    // on.
    for (std::uint64_t i = shard; i < all; i += files.size()) {
      const std::size_t cell = i % simulated.cells();
      const BenchmarkRun run = simulated.run(cell, campaign.seed + i / simulated.cells());
      seconds += secondsOf([&] { stored.add(cell, run); });
    }
  }
  std::printf("store a run: %.0f us (%llu runs)\n", 1e6 * seconds / static_cast<double>(all),
              static_cast<unsigned long long>(all));
  double bytes = 0;
  for (const fs::path& file : files) bytes += static_cast<double>(fs::file_size(file));
  std::printf("files of runs: %.0f MB\n", bytes / 1e6);
}

void measureSteps(const Campaign& campaign, const fs::path& folder) {
  CampaignResult result;
  result.start = std::chrono::system_clock::now();
  result.cells = cellsOf(campaign);
  std::unique_ptr<RunFile> stored;
  const auto step = [&](const std::string& what, const std::function<void()>& work) {
    const double seconds = secondsOf(work);
    print(what, seconds, largestMemory(RUSAGE_SELF));
  };
  step("resume", [&] {
    stored = std::make_unique<RunFile>(folder / "runs.jsonl", Mode::resume, campaign, result.cells);
  });
  step("rows and database", [&] { writeReports(campaign, result, stored->runs(), folder); });
  step("database alone",
       [&] { writeOmplDatabase(campaign, result, stored->runs(), folder / "campaign.db"); });
  step("report", [&] { writeReport(campaign, result.cells, folder, stored->sessions()); });
  std::printf("report.html: %.1f MB\n",
              static_cast<double>(fs::file_size(folder / "report.html")) / 1e6);
}

void measureProgram(const fs::path& campaign, const fs::path& folder) {
  const std::string command = std::string("'") + CORRIDOR_PROGRAM + "' benchmark '" +
                              campaign.string() + "' -o '" + folder.string() +
                              "' --resume >/dev/null 2>&1";
  int status = 0;
  const double seconds = secondsOf([&] { status = std::system(command.c_str()); });
  if (status != 0) throw std::runtime_error("failed: " + command);
  print("corridor benchmark --resume", seconds, largestMemory(RUSAGE_CHILDREN));
}

void run(const Arguments& arguments) {
  const fs::path folder = arguments.text("--out");
  if (folder.empty()) throw std::runtime_error("--out FOLDER is required");
  if (fs::exists(folder / "results"))
    throw std::runtime_error((folder / "results").string() + ": exists; name another folder");
  SimulatedSize size;
  const auto number = [&](const char* name, std::size_t fallback) {
    return static_cast<std::size_t>(arguments.number(name, static_cast<double>(fallback)));
  };
  size.runs = number("--runs", size.runs);
  size.problems = number("--problems", size.problems);
  size.variants = number("--variants", size.variants);
  size.planners = number("--planners", size.planners);
  const std::size_t seed = number("--seed", 1), shards = number("--shards", 1);
  const fs::path file = writeSimulated(size, folder);
  const Campaign campaign = readCampaign(file);
  std::printf("%zu problems, %zu variants, %zu planners, %llu runs each; seed %zu\n", size.problems,
              size.variants, size.planners, static_cast<unsigned long long>(campaign.runs), seed);
  std::vector<fs::path> files{folder / "results" / "runs.jsonl"};
  if (arguments.has("--shards")) {
    files.clear();
    for (std::size_t k = 1; k <= shards; ++k)
      files.push_back(folder / ("shard_" + std::to_string(k)) / "runs.jsonl");
  }
  inFork([&] {
    SimulatedRuns simulated(campaign, seed);
    store(campaign, simulated, files);
  });
  if (arguments.has("--shards")) return;
  inFork([&] { measureSteps(campaign, folder / "results"); });
  inFork([&] { measureProgram(file, folder / "results"); });
}

}  // namespace
}  // namespace corridor::bench

int main(int argc, char** argv) {
  return corridor::bench::runWith(
      argc, argv,
      {"--out", "--runs", "--problems", "--variants", "--planners", "--seed", "--shards"},
      corridor::bench::run);
}
