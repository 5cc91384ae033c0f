#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace corridor {

struct ChildLimits {
  /// Seconds that the parent waits for the first message, for the next … Where the last one came,
  /// the child's work is done.
  std::vector<double> patience;
  /// What the child may allocate beyond what its parent has; 0: no limit.
  std::size_t bytes = 0;
};

/// What became of a child process.
struct ChildEnd {
  std::vector<std::string> messages;  ///< as far as they came
  std::string failure;                ///< why not all: "killed by signal 11 (Segmentation fault)"
};

/// Some work in a process of its own: a crash, endless work or a lack of memory there costs that
/// work only. The child has a copy of all that the caller has; what it changes is lost, but for the
/// messages that it sends (any text without line breaks, as many as `patience` has). It ends
/// without running destructors, and when its parent does.
class ChildProcess {
 public:
  using Work = std::function<void(const std::function<void(const std::string&)>& send)>;

  /// Begins the work. @pre the caller has one thread.
  /// @throws std::system_error where there can be no further process or pipe.
  ChildProcess(const Work& work, const ChildLimits& limits);
  ~ChildProcess();  ///< kills it, if it isn't over
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;

  /// Takes what it has sent meanwhile, and looks at the clock. @returns whether it is over.
  bool advance();
  /// Kills it; `reason` is its failure, unless it was over.
  void stop(const std::string& reason);
  bool over() const { return id_ < 0; }
  const ChildEnd& end() const { return end_; }  ///< @pre over

  /// Until one of them has something to say, or for a short while (milliseconds).
  static void waitForAny(const std::vector<ChildProcess*>& children, int milliseconds);

 private:
  bool takeLine();
  void finish(bool kill);

  std::vector<double> patience_;
  std::chrono::steady_clock::time_point since_;  ///< the last message
  int pipe_ = -1, id_ = -1;
  std::string text_;
  ChildEnd end_;
};

/// Does the work, and waits for its end.
/// @param interrupted where it becomes true, the child is killed; failure: "interrupted".
/// @pre, @throws as ChildProcess.
ChildEnd inChild(const ChildProcess::Work& work, const ChildLimits& limits,
                 const std::atomic<bool>* interrupted = nullptr);

}  // namespace corridor
