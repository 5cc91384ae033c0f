#pragma once

#include <atomic>
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

/// Does some work in a process of its own: a crash, endless work or a lack of memory there costs
/// that work only. The child has a copy of all that the caller has; what it changes is lost, but
/// for the messages that it sends (any text without line breaks, as many as `patience` has). It
/// ends without running destructors, and when its parent does.
/// @pre the caller has one thread.
/// @param interrupted where it becomes true, the child is killed; failure: "interrupted".
/// @throws std::system_error where there can be no further process or pipe.
ChildEnd inChild(
    const std::function<void(const std::function<void(const std::string&)>& send)>& work,
    const ChildLimits& limits, const std::atomic<bool>* interrupted = nullptr);

}  // namespace corridor
