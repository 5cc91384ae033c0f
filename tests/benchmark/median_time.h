#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "collision/core/quantiles.h"

namespace corridor::bench {

/// Times call(i) three times for each i below `count`, and takes the shortest of the three times.
/// If all i together take more than two seconds, each is timed once. Returns these times in µs.
template <class Call>
std::vector<double> leastMicroseconds(std::size_t count, const Call& call) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> least(count, HUGE_VAL);
  const auto begin = Clock::now();
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto before = Clock::now();
      call(i);
      const std::chrono::duration<double, std::micro> time = Clock::now() - before;
      least[i] = std::min(least[i], time.count());
    }
    if (Clock::now() - begin > std::chrono::seconds(2)) break;
  }
  return least;
}

/// Returns the median of `leastMicroseconds`.
template <class Call>
double medianMicroseconds(std::size_t count, const Call& call) {
  return medianOf(leastMicroseconds(count, call));
}

}  // namespace corridor::bench
