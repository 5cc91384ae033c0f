#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace corridor::app {

/// Nanoseconds that one call takes.
///
/// Reading the clock costs some 30 ns, so a call that is quicker than `kLongEnough` is repeated
/// between two readings until that much has passed, and the mean of those repeats is taken: below
/// 1 % of it is the clock's. A query of several µs is asked just once.
///
/// @param ask the first call. @param again what is asked again; it must do the same work, so it
/// drops what an earlier answer left in a cache.
inline constexpr double kLongEnough = 5'000;
template <class Ask, class Again>
double nanosecondsOf(Ask&& ask, Again&& again) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double, std::nano>(Clock::now() - start).count();
  };
  const Clock::time_point start = Clock::now();
  ask();
  const double once = since(start);
  if (once >= kLongEnough) return once;
  const int times = static_cast<int>(kLongEnough / std::max(once, kLongEnough / 200)) + 1;
  const Clock::time_point batch = Clock::now();
  for (int i = 0; i < times; ++i) again();
  return since(batch) / times;
}

/// The middle one of some numbers, or the mean of the two in the middle. @pre not empty.
template <class Numbers>
double median(Numbers numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  const double upper = *middle;
  if (numbers.size() % 2) return upper;
  return (*std::max_element(numbers.begin(), middle) + upper) / 2;
}

}  // namespace corridor::app
