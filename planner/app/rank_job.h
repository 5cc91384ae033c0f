#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "planner/jobs/rank_executor.h"

/// Commands under `mpirun`.
namespace corridor::app {

/// The part that this process has in a job under `mpirun`. A process that was started without
/// `mpirun` is alone.
class RankJob {
 public:
  /// Joins the job, if there is one. @param jobs the number of tasks that each rank does at a time.
  /// @throws InputError as joinRanks.
  explicit RankJob(std::size_t jobs);

  /// Whether this process does the tasks that rank 0 hands out: true on all ranks except rank 0. If
  /// so, this process must call `serve`.
  bool serves() const { return ranks_ && ranks_->rank() > 0; }
  /// The executor that does tasks on the other ranks; null for a process that is alone.
  /// @pre `serves()` is false.
  RankExecutor* executor() { return executor_ ? &*executor_ : nullptr; }
  /// Calls `listenForInterrupts`. In a job, a second signal does nothing, since each rank may get
  /// several signals.
  const std::atomic<bool>& listen() const;
  /// Does the tasks that rank 0 hands out, until rank 0 ends the job.
  /// @pre `serves()` is true. @returns the exit status.
  int serve(const RankSetUp& setUp);

 private:
  std::unique_ptr<Ranks> ranks_;
  std::optional<RankExecutor> executor_;  // ends before `ranks_`
};

/// On rank 0, and in a process that is alone, returns at once. On any other rank, waits for 30 s,
/// or until `mpirun` ends this process. Under `mpirun`, all ranks find the same faults in the
/// command line. Rank 0 reports them and ends. While the other ranks wait here, `mpirun` ends them.
void letRank0Report();

}  // namespace corridor::app
