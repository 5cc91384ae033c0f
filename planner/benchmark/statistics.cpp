#include "planner/benchmark/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/normal.hpp>

namespace corridor {

Interval medianInterval(std::vector<double> values) {
  const double infinity = std::numeric_limits<double>::infinity();
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  if (n == 0) return {-infinity, infinity};
  // The number of values below the median has a binomial distribution. k is the largest rank with
  // this property: the probability that fewer than k values are below the median is at most (1 −
  // kConfidence)/2. The interval is from the k-th smallest value to the k-th largest.
  const boost::math::binomial_distribution<double> below(static_cast<double>(n), 0.5);
  std::size_t k = 0,
              end = n / 2;  // k is found by bisection: a million values have half a million ranks
  while (k < end) {
    const std::size_t middle = k + (end - k) / 2;
    if (cdf(below, static_cast<double>(middle)) <= (1 - kConfidence) / 2)
      k = middle + 1;
    else
      end = middle;
  }
  return k == 0 ? Interval{-infinity, infinity} : Interval{values[k - 1], values[n - k]};
}

Interval shareInterval(std::size_t hits, std::size_t trials) {
  if (trials == 0) return {0, 1};
  const double n = static_cast<double>(trials), p = static_cast<double>(hits) / n;
  const double z = quantile(boost::math::normal_distribution<double>(), (1 + kConfidence) / 2);
  const double scale = 1 / (1 + z * z / n), middle = scale * (p + z * z / (2 * n));
  const double half = scale * z * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  // Without hits the lower bound is exactly 0, and without misses the upper bound is exactly 1.
  // Rounding could give other numbers.
  return {hits == 0 ? 0 : middle - half, hits == trials ? 1 : middle + half};
}

}  // namespace corridor
