#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/benchmark/executor.h"
#include "planner/benchmark/ranks.h"

namespace corridor {

/// Does tasks on the other ranks of a job under `mpirun`. Rank 0 has this executor; all other ranks
/// call `serveRanks`.
///
/// Setting up takes two messages for each rank. A task takes two messages, too: its number goes to
/// a rank that has a free place, and its end goes back to rank 0. A rank gets a task only when the
/// rank can begin it, so no task waits at one rank while another rank is idle.
///
/// Waiting takes little processor time: rank 0 looks for messages, and pauses between two looks for
/// 50 µs to 2 ms. The pauses grow while no message arrives. The other ranks look every 5 ms while a
/// task runs. So 2 ms may pass after the end of a task before the next task begins.
class RankExecutor final : public Executor {
 public:
  /// @param jobs tasks at a time on each of the other ranks. @pre ranks.rank() is 0; at least two
  /// ranks; `ranks` outlives this object.
  RankExecutor(Ranks& ranks, std::size_t jobs);
  /// Ends the other ranks: their calls of `serveRanks` return.
  ~RankExecutor() override;

  /// Makes the other ranks set up, and waits until all of them are set up. So no task begins if a
  /// rank can't do its part. @param setUp the argument of the `RankSetUp` of each rank. @pre called
  /// once, before the first task. @throws InputError with the first fault that a rank reports.
  void begin(const std::string& setUp);

  std::size_t places() const override { return places_; }
  std::size_t underWay() const override { return underWay_; }
  bool start(std::uint64_t task) override;
  /// If a signal arrived at another rank, it is raised in this process, too.
  /// @throws InputError if a rank reports that it can't do its part.
  std::vector<TaskEnd> wait(int milliseconds) override;
  std::vector<std::uint64_t> stop() override;
  /// Number of messages sent and received so far.
  std::uint64_t messages() const { return messages_; }

 private:
  void sendTo(int rank, std::string text);
  void take(RankMessage message, std::vector<TaskEnd>& ends);

  Ranks& ranks_;
  std::size_t places_, underWay_ = 0;
  std::deque<int> free_;  ///< a rank for each free place
  std::uint64_t messages_ = 0;
  std::optional<Fault> fault_;  ///< the first fault that a rank reported
};

/// Makes the executor of a rank, when rank 0 calls `RankExecutor::begin`. @param setUp the text
/// that rank 0 sent. If the function throws, rank 0 reports the exception's text, and the job ends.
using RankSetUp = std::function<std::unique_ptr<Executor>(const std::string& setUp)>;

/// Does the tasks that rank 0 hands out, until rank 0 ends the job. Tasks that are under way are
/// then killed.
/// @param signal returns the number of the signal that arrived at this process, or 0. The number is
/// sent to rank 0, which decides what happens.
void serveRanks(Ranks& ranks, const RankSetUp& setUp, const std::function<int()>& signal);

}  // namespace corridor
