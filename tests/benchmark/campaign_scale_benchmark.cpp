/// Measures what a campaign of many runs costs: `campaign_scale_benchmark --out FOLDER [--runs N]
/// [--problems N] [--variants N] [--planners N] [--seed N] [--shards N]`.
///
/// Writes a simulated campaign into the folder (simulated_campaign.h), fills its database
/// `results/campaign.db`, and measures:
/// * storing a run: each in a transaction of its own, as a campaign does, and many together;
/// * resuming (reading the database into memory), writing the rows and logs, and writing the
///   report: the time of each, and the largest memory that the process has used by then;
/// * the program itself: `corridor benchmark FOLDER/campaign.yaml -o FOLDER/results --resume`,
///   which has no run to make. With --shards, it only stores the runs, in turn in the databases
///   `shard_1/campaign.db`, …, which `corridor benchmark --merge` can then merge.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "planner/benchmark/campaign_database.h"
#include "planner/benchmark/report.h"
#include "planner/benchmark/write_reports.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/simulated_campaign.h"

namespace corridor::bench {
namespace {

namespace fs = std::filesystem;
using Mode = CampaignDatabase::Mode;

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

/// Stores all runs. With K databases, each gets every K-th run, in the order in which a campaign
/// makes its runs.
void store(const Campaign& campaign, SimulatedRuns& simulated, const std::vector<fs::path>& files) {
  constexpr std::uint64_t kAlone = 1000, kTogether = 10'000;
  const std::uint64_t all = simulated.cells() * campaign.runs;
  double aloneTime = 0, togetherTime = 0;
  std::uint64_t alone = 0, together = 0;
  for (std::size_t shard = 0; shard < files.size(); ++shard) {
    fs::create_directories(files[shard].parent_path());
    std::vector<CampaignCell> cells = cellsOf(campaign);
    CampaignDatabase database(files[shard], Mode::fresh, campaign, cells);
    std::vector<std::pair<std::size_t, BenchmarkRun>> runs;
    const auto flush = [&](bool each) {
      (each ? alone : together) += runs.size();
      (each ? aloneTime : togetherTime) += secondsOf([&] {
        const auto add = [&] {
          for (const auto& [cell, run] : runs) database.add(cell, run);
        };
        each ? add() : database.addTogether(add);
      });
      runs.clear();
    };
    // The order is that of a campaign: all cells with the first seed, then with the second, and so
    // on.
    for (std::uint64_t i = shard; i < all; i += files.size()) {
      const std::size_t cell = i % simulated.cells();
      runs.emplace_back(cell, simulated.run(cell, campaign.seed + i / simulated.cells()));
      if (runs.size() == kTogether || (alone == 0 && runs.size() == kAlone)) flush(alone == 0);
    }
    flush(false);
  }
  std::printf("store a run: %.0f us (%llu runs); many together: %.0f us (%llu runs)\n",
              1e6 * aloneTime / static_cast<double>(std::max<std::uint64_t>(alone, 1)),
              static_cast<unsigned long long>(alone),
              1e6 * togetherTime / static_cast<double>(std::max<std::uint64_t>(together, 1)),
              static_cast<unsigned long long>(together));
  double bytes = 0;
  for (const fs::path& file : files) bytes += static_cast<double>(fs::file_size(file));
  std::printf("database: %.0f MB\n", bytes / 1e6);
}

void measureSteps(const Campaign& campaign, const fs::path& folder) {
  CampaignResult result;
  result.start = std::chrono::system_clock::now();
  result.cells = cellsOf(campaign);
  std::unique_ptr<CampaignDatabase> database;
  const auto step = [&](const std::string& what, const std::function<void()>& work) {
    const double seconds = secondsOf(work);
    print(what, seconds, largestMemory(RUSAGE_SELF));
  };
  step("resume", [&] {
    database = std::make_unique<CampaignDatabase>(folder / "campaign.db", Mode::resume, campaign,
                                                  result.cells);
  });
  step("runs.csv, summary, logs",
       [&] { writeReports(campaign, result, database->runs(), folder); });
  step("report", [&] { writeReport(campaign, result.cells, folder, database->sessions()); });
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
  std::vector<fs::path> files{folder / "results" / "campaign.db"};
  if (arguments.has("--shards")) {
    files.clear();
    for (std::size_t k = 1; k <= shards; ++k)
      files.push_back(folder / ("shard_" + std::to_string(k)) / "campaign.db");
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
