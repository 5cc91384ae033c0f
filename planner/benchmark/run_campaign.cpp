#include "planner/benchmark/run_campaign.h"

#include <algorithm>
#include <deque>
#include <map>

namespace corridor {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds between the parent's tests of `interrupted`.
constexpr int kCampaignPollMs = 200;

struct QueuedRun {
  std::size_t cell = 0;
  std::uint64_t seed = 0;
};

/// Compares runs with runs, and runs with seeds, by seed.
struct BySeed {
  static std::uint64_t seedOf(const BenchmarkRun& run) { return run.seed; }
  static std::uint64_t seedOf(std::uint64_t seed) { return seed; }
  template <class A, class B>
  bool operator()(const A& a, const B& b) const {
    return seedOf(a) < seedOf(b);
  }
};

/// Returns the runs to make, in the order in which they begin.
std::deque<QueuedRun> tasksOf(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  std::deque<QueuedRun> tasks;
  const std::size_t variants = campaign.variants.size();
  const auto isMissing = [&](std::size_t cell, std::uint64_t seed) {
    return hasRun(campaign, cell, cells.size(), seed) &&
           !std::binary_search(cells[cell].runs.begin(), cells[cell].runs.end(), seed, BySeed());
  };
  // cellsOf puts the variants of a problem and planner next to each other.
  for (std::size_t first = 0; first < cells.size(); first += variants)
    for (std::uint64_t i = 0; i < campaign.runs; ++i)
      for (std::size_t v = 0; v < variants; ++v)
        if (isMissing(first + v, campaign.seed + i))
          tasks.push_back({first + v, campaign.seed + i});
  return tasks;
}

/// Mean durations of finished runs, to estimate the time left.
class Durations {
 public:
  Durations(std::size_t cells, const std::deque<QueuedRun>& tasks) : cells_(cells) {
    for (const QueuedRun& task : tasks) ++cells_[task.cell].waiting;
  }
  void begin(std::size_t cell) { --cells_[cell].waiting; }
  void add(std::size_t cell, double seconds) {
    cells_[cell].seconds += seconds, ++cells_[cell].runs;
    all_.seconds += seconds, ++all_.runs;
  }
  /// Returns an estimate of the seconds that all waiting runs take if they are made one after the
  /// other. For each waiting run, the estimate is the mean duration of the finished runs of its
  /// cell, or of all finished runs if no run of its cell is finished. Returns a negative number if
  /// no run is finished.
  double ofWaiting() const {
    if (all_.runs == 0) return -1;
    double sum = 0;
    for (const Sum& cell : cells_)
      sum += static_cast<double>(cell.waiting) * (cell.runs > 0 ? cell.mean() : all_.mean());
    return sum;
  }

 private:
  struct Sum {
    double seconds = 0;
    std::size_t runs = 0, waiting = 0;
    double mean() const { return seconds / static_cast<double>(runs); }
  };
  std::vector<Sum> cells_;
  Sum all_;
};

/// Returns the number of the task for a run: cell and seed in one number. Seeds have 32 bits
/// (checkCampaign).
std::uint64_t taskOf(const QueuedRun& run) {
  return std::uint64_t{run.cell} << 32 | run.seed;
}
QueuedRun queuedRun(std::uint64_t task) {
  return {static_cast<std::size_t>(task >> 32), task & 0xffffffff};
}

}  // namespace

TaskStarter runStarter(const Campaign& campaign) {
  return [&campaign, cells = cellsOf(campaign)](std::uint64_t task) {
    const auto [index, seed] = queuedRun(task);
    const CampaignCell& cell = cells[index];
    return startRun(campaign.verify ? &campaign.problems[cell.problem] : nullptr,
                    problemOfRun(campaign, cell, seed), campaign.digests[cell.problem],
                    campaign.variants[cell.variant].competitor, campaign.limits,
                    trajectoriesOf(campaign, cell));
  };
}

CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options,
                           std::vector<CampaignCell> cells) {
  CampaignResult result;
  result.start = std::chrono::system_clock::now();
  std::deque<QueuedRun> tasks = tasksOf(campaign, cells);
  std::uint64_t done = 0;
  for (const CampaignCell& cell : cells) done += cell.runs.size();
  const std::uint64_t total = done + tasks.size();
  Durations durations(cells.size(), tasks);
  if (!campaign.shard)  // a vector that grows may need twice the memory
    for (CampaignCell& cell : cells) cell.runs.reserve(campaign.runs);
  std::map<std::uint64_t, Clock::time_point> since;  // of the tasks under way
  LocalExecutor local(options.jobs, runStarter(campaign));
  Executor& executor = options.executor ? *options.executor : local;

  /// Begins the next run. @returns false if another run must end before it can begin.
  const auto begin = [&] {
    const QueuedRun task = tasks.front();
    if (options.progress) {
      const double left = durations.ofWaiting();
      options.progress({done, total,
                        left < 0 ? left : left / static_cast<double>(executor.places()),
                        cells[task.cell], task.seed});
    }
    if (!executor.start(taskOf(task))) return false;
    since[taskOf(task)] = Clock::now();
    durations.begin(task.cell);
    tasks.pop_front();
    return true;
  };
  const auto end = [&](const TaskEnd& one) {
    const auto [cell, seed] = queuedRun(one.task);
    durations.add(cell, std::chrono::duration<double>(Clock::now() - since.at(one.task)).count());
    since.erase(one.task);
    BenchmarkRun run = runOf(one.end, seed, trajectoriesOf(campaign, cells[cell]));
    if (options.done) options.done(cell, run);
    ++done;
    auto& runs = cells[cell].runs;
    runs.insert(std::upper_bound(runs.begin(), runs.end(), run.seed, BySeed()), std::move(run));
  };
  const auto interrupted = [&] { return options.interrupted && options.interrupted->load(); };
  while (!(tasks.empty() && since.empty()) && !interrupted()) {
    while (!tasks.empty() && since.size() < executor.places() && !interrupted())
      if (!begin()) break;
    if (interrupted()) break;
    for (const TaskEnd& one : executor.wait(kCampaignPollMs)) end(one);
  }
  result.interrupted = !(tasks.empty() && since.empty());
  executor.stop();
  result.cells = std::move(cells);
  result.seconds =
      std::chrono::duration<double>(std::chrono::system_clock::now() - result.start).count();
  return result;
}

CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options) {
  return runCampaign(campaign, options, cellsOf(campaign));
}

}  // namespace corridor
