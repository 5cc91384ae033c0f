#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "planner/python/bindings.h"

namespace corridor::python {

/// Calls work(i) for each i below `count`, on several threads.
/// @param threads 0: as many as the machine has.
/// @param stop is called every 50 ms by the calling thread, which does no other work; if `stop`
/// returns true, the function ends soon. With 16 items or fewer, the calling thread does the work,
/// and `stop` is not called.
/// @returns false if `stop` ended the work early. @throws the first exception that `work` throws.
template <class Work, class Stop>
bool forEachInParallel(std::size_t count, std::size_t threads, const Work& work, const Stop& stop) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  constexpr std::size_t kChunk = 16;  // items that a thread takes at once
  std::atomic<std::size_t> next = 0;
  std::size_t running = 0;
  std::condition_variable ended;
  std::atomic<bool> stopped = false;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&] {
    try {
      for (std::size_t begin; !stopped && (begin = next.fetch_add(kChunk)) < count;)
        for (std::size_t i = begin; i < std::min(count, begin + kChunk); ++i) work(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      stopped = true;
    }
  };
  threads = std::min(threads, (count + kChunk - 1) / kChunk);
  if (threads <= 1 && count <= kChunk) {
    run();  // little work: not worth a thread
  } else {
    std::vector<std::jthread> workers;
    running = threads;
    for (std::size_t k = 0; k < threads; ++k)
      workers.emplace_back([&] {
        run();
        const std::lock_guard lock(mutex);
        --running;
        ended.notify_one();
      });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, std::chrono::milliseconds(50), [&] { return running == 0; })) {
      lock.unlock();
      if (!stopped && stop()) stopped = true;
      lock.lock();
    }
  }
  if (failure) std::rethrow_exception(failure);
  return !stopped;
}

/// Calls `forEachInParallel` without Python's lock. Ctrl-C ends the calls, and raises
/// KeyboardInterrupt.
template <class Work>
void forEachUnlocked(std::size_t count, std::size_t threads, const Work& work) {
  bool done = false;
  {
    const py::gil_scoped_release unlocked;
    done = forEachInParallel(count, threads, work, runSignalHandlers);
  }
  if (!done) throw py::error_already_set();
}

}  // namespace corridor::python
