#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>

namespace corridor {

/// Durations of a call, in nanoseconds; see nanosecondsOf.
inline constexpr double kRepeatBelow = 5'000, kMaybePreempted = 100'000;

/// Returns the nanoseconds that one call takes.
///
/// Reading the clock costs some 30 ns. If the first call takes less than `kRepeatBelow`
/// nanoseconds, it is therefore repeated between two readings, as often as it would fit into
/// `kRepeatBelow`, but at most 201 times. The mean of the repeats is returned; the readings are
/// about 1 % of it. A longer call runs once. During a call of `kMaybePreempted` nanoseconds or
/// more, the system may have run another program. The result is then the smaller of the elapsed
/// time and the thread's own processor time. (For shorter calls, reading the clock of processor
/// time takes too long.)
///
/// @param ask makes the first call of the function that is timed.
/// @param again makes a repeated call. It must do the same work as the first, so it must clear what
/// an earlier call left in a cache.
template <class Ask, class Again>
double nanosecondsOf(Ask&& ask, Again&& again) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
  };
  const auto ownTime = [] {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec);
  };
  const double own = ownTime();
  const Clock::time_point start = Clock::now();
  ask();
  const double once = since(start);
  if (once >= kMaybePreempted) return std::min(once, ownTime() - own);
  if (once >= kRepeatBelow) return once;
  const int times = static_cast<int>(kRepeatBelow / std::max(once, kRepeatBelow / 200)) + 1;
  const Clock::time_point batch = Clock::now();
  for (int i = 0; i < times; ++i) again();
  return since(batch) / times;
}

}  // namespace corridor
