#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace corridor {

struct ChildLimits {
  /// Seconds that the parent waits for the first message of a piece of work, for the second, and so
  /// on. The work is finished when the last of these messages has arrived.
  std::vector<double> patience;
  /// Memory that the child may allocate beyond what its parent has; 0: no limit.
  std::size_t bytes = 0;
};

/// How a piece of work in a child process ended.
struct ChildEnd {
  std::vector<std::string> messages;  ///< the messages that arrived
  /// Why messages are missing: "killed by signal 11 (Segmentation fault)". Empty if all messages
  /// arrived.
  std::string failure;
};

/// Work in a process of its own: a crash, an endless loop or a lack of memory there costs that work
/// only. The child has a copy of all of the caller's memory; changes that it makes to this copy are
/// lost. The only result of the child is the messages that it sends, one for each entry of
/// `ChildLimits::patience`. A message is any text without line breaks. The child ends by `_exit`,
/// so the destructors of objects that existed before it started do not run in it. The child is
/// killed when its parent ends.
class ChildProcess {
 public:
  using Send = std::function<void(const std::string&)>;
  using Work = std::function<void(const Send& send)>;
  /// One of many tasks; the caller decides what the number stands for.
  using TaskWork = std::function<void(std::uint64_t task, const Send& send)>;

  /// Starts the work. @pre the caller has one thread, or the work needs no lock that another thread
  /// may hold. (The threads of MPI are harmless, and glibc's own locks are free in the child.)
  /// @throws std::system_error if no further process or socket can be created.
  ChildProcess(const Work& work, const ChildLimits& limits);
  /// Starts the work on a first task. When it has sent its last message, the child waits for
  /// `begin`. The limits of memory hold for all tasks together, as do those of `ulimit`.
  ChildProcess(const TaskWork& work, std::uint64_t task, const ChildLimits& limits);
  ~ChildProcess();  ///< kills the child if it is still running
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  /// Reads the messages sent so far, and kills the child if its next message is overdue
  /// (`ChildLimits::patience`). @returns whether the work has ended.
  bool poll();
  /// Gives the next task to a child that was made for tasks. @pre `poll()` returned true.
  /// @returns false if the child has ended.
  bool begin(std::uint64_t task);
  /// Kills the child, and sets `end().failure` to `reason`. Does nothing if the child has ended.
  void stop(const std::string& reason);
  bool over() const { return id_ < 0; }  ///< whether the child has ended
  /// Whether a message has arrived, as of the last call of `poll`.
  bool hasSent() const { return !end_.messages.empty(); }
  const ChildEnd& end() const { return end_; }  ///< @pre `poll()` returned true

  /// Waits until one of the children has sent something or ended, for at most `milliseconds`.
  static void waitForAny(const std::vector<ChildProcess*>& children, int milliseconds);

 private:
  /// Makes the process. In the child, calls run(socket, send), and never returns.
  void start(const std::function<void(int socket, const Send& send)>& run, std::size_t bytes);
  bool hasAll() const { return end_.messages.size() == patience_.size(); }
  bool takeLine();
  void finish(bool kill);

  std::vector<double> patience_;
  std::chrono::steady_clock::time_point since_;  ///< time of the last message
  bool isForTasks_;
  int socket_ = -1, id_ = -1;
  std::string text_;
  ChildEnd end_;
};

/// Does the work in a child process, and waits until the child has ended. @param interrupted when
/// it becomes true, the child is killed, and the failure is "interrupted". @pre and @throws: the
/// same as for the constructor of ChildProcess.
ChildEnd inChild(const ChildProcess::Work& work, const ChildLimits& limits,
                 const std::atomic<bool>* interrupted = nullptr);

}  // namespace corridor
