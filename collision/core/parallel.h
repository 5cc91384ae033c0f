#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace corridor {

/// Runs `work()` on `threads` threads and returns when all calls have returned. The calling thread
/// is one of these threads, and the only one if `threads` is 0 or 1. If the system cannot start
/// that many threads, fewer run. If calls throw, rethrows the first exception after all calls have
/// ended.
template <class Work>
void onThreads(unsigned threads, const Work& work) {
  std::exception_ptr error;
  std::mutex mutex;
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    try {
      for (unsigned i = 1; i < threads; ++i) others.emplace_back(guarded);
    } catch (const std::system_error&) {
    }
    guarded();
  }
  if (error) std::rethrow_exception(error);
}

/// Partitions [0, n) into subranges and calls `work(begin, end)` once for each subrange, in any
/// order, on at most `threads` threads. If a call throws, some subranges may be left out, and the
/// first exception is rethrown.
template <class Work>
void inParts(unsigned threads, std::size_t n, const Work& work) {
  constexpr std::size_t kPart = 16384;
  std::mutex mutex;
  std::size_t next = 0;
  const auto share = static_cast<unsigned>(std::min<std::size_t>(threads, n / kPart + 1));
  onThreads(share, [&] {
    while (true) {
      std::size_t begin = 0;
      {
        const std::lock_guard lock(mutex);
        begin = next;
        next = std::min(n, begin + kPart);
      }
      if (begin == n) return;
      work(begin, std::min(n, begin + kPart));
    }
  });
}

/// Runs the task `first`, and all tasks that running tasks create, on `threads` threads, in any
/// order. Each thread calls `makeWorker()` once, which returns a function object `worker`. The
/// thread runs each of its tasks by the call `worker(task, more)`. The worker appends new tasks to
/// `more`. If a worker throws, no further task is started, and the first exception is rethrown.
template <class Task, class MakeWorker>
void runTasks(unsigned threads, Task first, const MakeWorker& makeWorker) {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Task> waiting;
  waiting.push_back(std::move(first));
  unsigned running = 0;
  bool failed = false;
  onThreads(threads, [&] {
    std::unique_lock lock(mutex);
    try {
      auto worker = makeWorker();
      std::vector<Task> more;
      while (true) {
        changed.wait(lock, [&] { return failed || !waiting.empty() || running == 0; });
        if (failed || waiting.empty()) break;
        Task task = std::move(waiting.back());
        waiting.pop_back();
        ++running;
        lock.unlock();
        more.clear();
        worker(task, more);
        lock.lock();
        --running;
        for (Task& t : more) waiting.push_back(std::move(t));
        changed.notify_all();
      }
    } catch (...) {
      if (!lock.owns_lock()) lock.lock();
      failed = true;
      changed.notify_all();
      throw;
    }
    changed.notify_all();
  });
}

}  // namespace corridor
