#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "collision/core/quantiles.h"

namespace corridor::bench {

/// Times call(i) three times for each i below `count`, and takes the shortest of the three times.
/// Returns the median of these times over all i, in µs.
template <class Call>
double medianMicroseconds(std::size_t count, const Call& call) {
  std::vector<double> least(count, HUGE_VAL);
  for (int round = 0; round < 3; ++round)
    for (std::size_t i = 0; i < count; ++i) {
      const auto before = std::chrono::steady_clock::now();
      call(i);
      const std::chrono::duration<double, std::micro> time =
          std::chrono::steady_clock::now() - before;
      least[i] = std::min(least[i], time.count());
    }
  return medianOf(least);
}

}  // namespace corridor::bench
