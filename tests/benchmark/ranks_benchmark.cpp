// Measures how `mpirun` campaigns hand out runs: messages, time and processor time of rank 0 per
// run, for runs that take no time. Usage: `mpirun -n 64 --oversubscribe
// build/release/tests/ranks_benchmark [RUNS [BYTES]]`. BYTES is the length of each result. The
// default is 3000, the length for a run without trajectories.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>

#include "planner/jobs/rank_executor.h"

namespace {

using namespace corridor;

/// Tasks that are done as soon as they are started.
class NoWork final : public Executor {
 public:
  explicit NoWork(std::size_t bytes) : result_(bytes, 'x') {}
  std::size_t places() const override { return 1; }
  std::size_t underWay() const override { return tasks_.size(); }
  bool start(std::uint64_t task) override {
    tasks_.push_back(task);
    return true;
  }
  std::vector<TaskEnd> wait(int) override {
    std::vector<TaskEnd> ends;
    for (const std::uint64_t task : tasks_) ends.push_back({task, {{"", result_}, ""}});
    tasks_.clear();
    return ends;
  }
  std::vector<std::uint64_t> stop() override { return {}; }

 private:
  std::string result_;
  std::vector<std::uint64_t> tasks_;
};

double processorSeconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Hands out all tasks. @returns false if the result of a task is missing, or came twice.
bool handOut(RankExecutor& executor, std::uint64_t tasks, std::size_t bytes) {
  std::vector<char> done(tasks, 0);
  std::uint64_t next = 0, ended = 0;
  while (ended < tasks) {
    while (next < tasks && executor.underWay() < executor.places()) executor.start(next++);
    for (const TaskEnd& one : executor.wait(200)) {
      if (done.at(one.task)++ || one.end.messages.at(1).size() != bytes) return false;
      ++ended;
    }
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t tasks = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100'000;
  const std::size_t bytes = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 3000;
  const std::unique_ptr<Ranks> ranks = joinRanks();
  if (!ranks) {
    std::cerr << "ranks_benchmark: call it by mpirun, with two ranks or more\n";
    return 2;
  }
  if (ranks->rank() > 0) {
    serveRanks(
        *ranks, [&](const std::string&) { return std::make_unique<NoWork>(bytes); },
        [] { return 0; });
    return 0;
  }
  RankExecutor executor(*ranks, 1);
  executor.begin("", std::atomic<bool>(false));
  handOut(executor, executor.places(), bytes);  // all ranks are ready
  const std::uint64_t messages = executor.messages();
  const double processor = processorSeconds();
  const auto begun = std::chrono::steady_clock::now();
  const bool right = handOut(executor, tasks, bytes);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  const auto per = [&](double seconds) { return 1e6 * seconds / static_cast<double>(tasks); };
  std::printf(
      "%d ranks, %llu runs: %.2f messages, %.1f us, %.1f us of rank 0's processor per run\n",
      ranks->size(), static_cast<unsigned long long>(tasks),
      static_cast<double>(executor.messages() - messages) / static_cast<double>(tasks),
      per(took.count()), per(processorSeconds() - processor));
  return right ? 0 : 1;
}
