#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "planner/jobs/child_process.h"

namespace corridor {

/// How one of many tasks ended. A task is a number; the caller decides what the number stands for.
struct TaskEnd {
  std::uint64_t task = 0;
  /// How the task ended. Only the text of the last message is kept; the other messages are empty
  /// texts.
  ChildEnd end;
};

/// Does tasks in child processes, several at a time. The processes are on this machine, or on
/// several machines (rank_executor.h).
class Executor {
 public:
  virtual ~Executor() = default;  ///< kills the tasks that are under way
  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  virtual std::size_t places() const = 0;    ///< the number of tasks that can run at a time
  virtual std::size_t underWay() const = 0;  ///< tasks that were started and have not ended
  /// Starts a task. @pre `underWay() < places()`. @returns false if the system can't create a
  /// further process while other tasks are under way: then one of these tasks must end first.
  /// @throws std::system_error if the system can't create a process and no task is under way.
  virtual bool start(std::uint64_t task) = 0;
  /// Waits until a task ends, or a signal arrives, for at most `milliseconds`.
  /// @returns the tasks that have ended since the previous call.
  virtual std::vector<TaskEnd> wait(int milliseconds) = 0;
  /// Kills the tasks that may be killed (`Killable`); `wait` does not return these tasks. All other
  /// tasks continue to their normal end.
  /// @returns the tasks that are known to have been killed when this function returns.
  /// LocalExecutor returns all killed tasks. RankExecutor returns none, because it does not wait
  /// for the other ranks.
  virtual std::vector<std::uint64_t> stop() = 0;
};

/// A function that starts a process for a task, and perhaps for later tasks. @throws
/// std::system_error for the same reasons as the constructor of ChildProcess.
using TaskStarter = std::function<ChildProcess(std::uint64_t task)>;

/// When a task may be killed by `stop`.
enum class Killable {
  always,
  untilItSends  ///< until its first message, after which it writes files
};

/// Does the tasks in child processes of this process. A child made by the constructor for
/// tasks does several, one after the other; all others do one. @pre the preconditions of the
/// constructor of ChildProcess.
class LocalExecutor final : public Executor {
 public:
  LocalExecutor(std::size_t places, TaskStarter starter, Killable killable = Killable::always);

  std::size_t places() const override { return places_; }
  std::size_t underWay() const override { return running_.size(); }
  bool start(std::uint64_t task) override;
  std::vector<TaskEnd> wait(int milliseconds) override;
  std::vector<std::uint64_t> stop() override;

 private:
  struct Running {
    std::uint64_t task;
    std::unique_ptr<ChildProcess> child;
  };

  std::size_t places_;
  TaskStarter starter_;
  Killable killable_;
  std::vector<Running> running_;
  std::vector<std::unique_ptr<ChildProcess>> idle_;  // they wait for a further task
};

}  // namespace corridor
