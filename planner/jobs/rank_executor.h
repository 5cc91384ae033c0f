#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/jobs/executor.h"
#include "planner/jobs/ranks.h"

namespace corridor {

/// Does tasks on ranks 1, 2, … of a job under `mpirun`. Rank 0 has this executor; all other ranks
/// call `serveRanks`.
///
/// Setting up takes two messages for each rank. A task takes two messages, too: its number goes to
/// a rank that has a free place, and its end goes back to rank 0. A rank gets a task only when the
/// rank can begin it, so no task waits at one rank while another rank is idle.
///
/// Waiting takes little processor time: between two polls for messages, rank 0 pauses for 50 µs to
/// 2 ms. The pauses grow while no message arrives. Another rank without a task pauses in the same
/// way; while tasks run, it polls at least every 5 ms. So after the end of a task, about 4 ms may
/// pass before the next task begins, or 7 ms if other tasks run at that rank.
class RankExecutor final : public Executor {
 public:
  /// @param jobs the number of tasks at a time on each of the other ranks. @pre ranks.rank() is 0;
  /// there are at least two ranks; `ranks` outlives this object.
  RankExecutor(Ranks& ranks, std::size_t jobs);
  /// Makes the calls of `serveRanks` at the other ranks return. Waits for them, at most 30 s.
  ~RankExecutor() override;

  /// Makes each of the other ranks call its `RankSetUp`, and waits until all of them are set up. So
  /// no task begins if a rank can't be set up. @param setUp the argument of these calls. @pre this
  /// function is called once, before the first task. @throws InputError with the first fault that a
  /// rank reports.
  /// @param interrupted if it becomes true, the function returns within 0.1 s. Then no task may be
  /// started. The destructor still waits for ranks that set up.
  void begin(const std::string& setUp, const std::atomic<bool>& interrupted);

  std::size_t places() const override { return places_; }
  std::size_t underWay() const override { return underWay_; }
  bool start(std::uint64_t task) override;
  /// If a signal arrived at another rank, this function raises the same signal in this process.
  /// If a rank reports that it can't do its tasks, the tasks that have already ended are returned
  /// first. @throws InputError in the next call.
  std::vector<TaskEnd> wait(int milliseconds) override;
  std::vector<std::uint64_t> stop() override;
  /// Number of messages sent and received so far.
  std::uint64_t messages() const { return messages_; }

 private:
  void sendTo(int rank, std::string text);
  void take(RankMessage message, std::vector<TaskEnd>& ends);

  Ranks& ranks_;
  std::size_t places_, underWay_ = 0;
  int ready_ = 0;         ///< ranks that are set up
  std::deque<int> free_;  ///< a rank for each free place
  std::uint64_t messages_ = 0;
  std::optional<Fault> fault_;  ///< the first fault that a rank reported
};

/// A function that makes the executor of a rank. `serveRanks` calls it when rank 0 calls
/// `RankExecutor::begin`. @param setUp the text that rank 0 sent. If the function throws, the
/// exception's text becomes an InputError at rank 0.
using RankSetUp = std::function<std::unique_ptr<Executor>(const std::string& setUp)>;

/// Does the tasks that rank 0 hands out, until rank 0 destroys its executor. Tasks that are still
/// under way are then killed.
/// @param signal returns the number of the signal that arrived at this process, or 0. The number is
/// sent to rank 0, which decides what happens.
void serveRanks(Ranks& ranks, const RankSetUp& setUp, const std::function<int()>& signal);

}  // namespace corridor
