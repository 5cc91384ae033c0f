#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

namespace ompl::base {
class SpaceInformation;
}

namespace corridor {

/// What OMPL asked the checkers of states and motions, of all threads together.
struct CheckingTally {
  std::atomic<std::uint64_t> states = 0;  ///< tested, samples of motions included
  std::atomic<std::uint64_t> motions = 0;
  std::atomic<std::int64_t> nanoseconds = 0;  ///< a state within a motion counts once

  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds); }
};

/// Counts and times what the checkers of `si` are asked, and changes nothing else. It costs some
/// 50 ns a test. @pre `tally` outlives them.
void tallyChecks(const std::shared_ptr<ompl::base::SpaceInformation>& si, CheckingTally& tally);

}  // namespace corridor
