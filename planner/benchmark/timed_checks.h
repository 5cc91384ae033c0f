#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace ompl::base {
class SpaceInformation;
}

namespace corridor {

/// Time spent in tests of states and motions, of all threads together.
class CheckingTime {
 public:
  void add(std::int64_t nanoseconds) { nanoseconds_ += nanoseconds; }
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_); }

 private:
  std::atomic<std::int64_t> nanoseconds_ = 0;
};

/// Puts a clock around the checkers of states and motions of `si`, and changes nothing else. It
/// costs some 50 ns a test. A state that is tested within a motion counts once.
/// @pre `time` outlives them.
void timeChecks(const std::shared_ptr<ompl::base::SpaceInformation>& si, CheckingTime& time);

}  // namespace corridor
