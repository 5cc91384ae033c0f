#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "planner/benchmark/child_process.h"

namespace corridor {

/// How one of many tasks ended. A task is a number; what it stands for is up to the caller.
struct TaskEnd {
  std::uint64_t task = 0;
  /// How the child process of the task ended. Only its last message is kept; the others are empty
  /// texts.
  ChildEnd end;
};

/// Does tasks, several at a time, each in a process of its own: on this machine, or on many
/// (rank_executor.h).
class Executor {
 public:
  virtual ~Executor() = default;  ///< kills the tasks that are under way
  Executor() = default;
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  virtual std::size_t places() const = 0;    ///< the number of tasks that can run at a time
  virtual std::size_t underWay() const = 0;  ///< tasks that were started and have not ended
  /// Starts a task. @pre `underWay() < places()`. @returns false if the system has no room for a
  /// further process: then a task that is under way must end first.
  /// @throws std::system_error if no task is under way, either.
  virtual bool start(std::uint64_t task) = 0;
  /// Waits until a task ends, or a signal arrives, for at most `milliseconds`.
  /// @returns the tasks that have ended since the call before.
  virtual std::vector<TaskEnd> wait(int milliseconds) = 0;
  /// Kills the tasks that may be killed; `wait` does not return them. All other tasks continue to
  /// their normal end.
  /// @returns the tasks that are already killed. For tasks on other ranks, this function does not
  /// wait, and returns none.
  virtual std::vector<std::uint64_t> stop() = 0;
};

/// Starts the process of a task. @throws std::system_error as ChildProcess.
using TaskStarter = std::function<ChildProcess(std::uint64_t task)>;

/// When a task may be killed by `stop`.
enum class Killable {
  always,
  untilItSends  ///< until its first message, after which it writes files
};

/// Does the tasks in child processes of this process. @pre as ChildProcess.
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
};

}  // namespace corridor
