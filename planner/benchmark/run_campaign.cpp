#include "planner/benchmark/run_campaign.h"

#include <algorithm>
#include <deque>
#include <list>

namespace corridor {
namespace {

using Clock = std::chrono::steady_clock;

/// Milliseconds between the parent's tests of `interrupted`.
constexpr int kCampaignPollMs = 200;

struct QueuedRun {
  std::size_t cell = 0;
  std::uint64_t seed = 0;
};

/// Returns the runs to make, in the order in which they begin.
std::deque<QueuedRun> tasksOf(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  std::deque<QueuedRun> tasks;
  const std::size_t variants = campaign.variants.size();
  const auto has = [&](std::size_t cell, std::uint64_t seed) {
    const auto& runs = cells[cell].runs;
    const auto at =
        std::lower_bound(runs.begin(), runs.end(), seed,
                         [](const BenchmarkRun& run, std::uint64_t of) { return run.seed < of; });
    return at != runs.end() && at->seed == seed;
  };
  // cellsOf puts the variants of a problem and planner next to each other.
  for (std::size_t first = 0; first < cells.size(); first += variants)
    for (std::uint64_t i = 0; i < campaign.runs; ++i)
      for (std::size_t v = 0; v < variants; ++v)
        if (!has(first + v, campaign.seed + i)) tasks.push_back({first + v, campaign.seed + i});
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
  /// Returns the estimated seconds of all waiting runs, one after the other. Each takes the mean
  /// time of its cell, or of all runs if its cell has none. Negative: unknown.
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

struct Running {
  QueuedRun task;
  Clock::time_point since;
  RunProcess run;
};

}  // namespace

CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options,
                           std::vector<CampaignCell> cells) {
  CampaignResult result;
  result.start = std::chrono::system_clock::now();
  std::deque<QueuedRun> tasks = tasksOf(campaign, cells);
  const std::uint64_t total = cells.size() * campaign.runs;
  std::uint64_t done = total - tasks.size();
  Durations durations(cells.size(), tasks);
  for (CampaignCell& cell : cells) cell.runs.reserve(campaign.runs);  // growing would need twice
  std::list<Running> running;  // its destructor kills these runs

  const auto begin = [&] {
    const QueuedRun task = tasks.front();
    const CampaignCell& cell = cells[task.cell];
    if (options.progress) {
      const double left = durations.ofWaiting();
      options.progress({done, total, left < 0 ? left : left / static_cast<double>(options.jobs),
                        cell, task.seed});
    }
    durations.begin(task.cell);
    tasks.pop_front();
    running.push_back(
        {task, Clock::now(),
         RunProcess(campaign.verify ? &campaign.problems[cell.problem] : nullptr,
                    plannedProblem(campaign, cell, task.seed), campaign.digests[cell.problem],
                    campaign.variants[cell.variant].competitor, campaign.limits,
                    trajectoriesOf(campaign, cell))});
  };
  const auto end = [&](Running& one) {
    durations.add(one.task.cell, std::chrono::duration<double>(Clock::now() - one.since).count());
    BenchmarkRun run = one.run.run();
    if (options.done) options.done(one.task.cell, run);
    ++done;
    auto& runs = cells[one.task.cell].runs;
    runs.insert(std::upper_bound(runs.begin(), runs.end(), run,
                                 [](const auto& a, const auto& b) { return a.seed < b.seed; }),
                std::move(run));
  };
  const auto interrupted = [&] { return options.interrupted && options.interrupted->load(); };
  while (!(tasks.empty() && running.empty())) {
    while (!tasks.empty() && running.size() < options.jobs && !interrupted()) begin();
    if (interrupted()) break;  // destroying `running` kills its runs
    std::vector<ChildProcess*> children;
    for (Running& one : running) children.push_back(&one.run.process());
    ChildProcess::waitForAny(children, kCampaignPollMs);
    std::erase_if(running, [&](Running& one) {
      const bool over = one.run.process().advance();
      if (over) end(one);
      return over;
    });
  }
  result.interrupted = !(tasks.empty() && running.empty());
  result.cells = std::move(cells);
  result.seconds =
      std::chrono::duration<double>(std::chrono::system_clock::now() - result.start).count();
  return result;
}

CampaignResult runCampaign(const Campaign& campaign, const CampaignOptions& options) {
  return runCampaign(campaign, options, cellsOf(campaign));
}

}  // namespace corridor
