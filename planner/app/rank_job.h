#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "planner/benchmark/rank_executor.h"

/// Commands under `mpirun`.
namespace corridor::app {

/// The part of this process in a job under `mpirun`, or that it is alone.
class RankJob {
 public:
  /// Joins the job, if there is one. @param jobs tasks at a time on each rank.
  /// @throws InputError as joinRanks.
  explicit RankJob(std::size_t jobs);

  /// Whether rank 0 hands out the tasks of this process, which has to call `serve`.
  bool serves() const { return ranks_ && ranks_->rank() > 0; }
  /// The other ranks' executor; null for a process that is alone. @pre !serves()
  RankExecutor* executor() { return executor_ ? &*executor_ : nullptr; }
  /// Listens for interrupts as `listenForInterrupts`. In a job, a second signal does nothing, since
  /// each rank may get several.
  const std::atomic<bool>& listen() const;
  /// Does what rank 0 hands out. @pre serves(). @returns the exit status.
  int serve(const RankSetUp& setUp);

 private:
  std::unique_ptr<Ranks> ranks_;
  std::optional<RankExecutor> executor_;  // ends before `ranks_`
};

/// Under `mpirun`, all ranks find the same faults in the command line. Rank 0 reports them and
/// ends, and `mpirun` then ends the others, which wait here meanwhile.
void letRank0Report();

}  // namespace corridor::app
