#include "collision/core/quantiles.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace corridor {
namespace {

/// Returns the value that has index `rank` in ascending order (from 0). Reorders `values`: moves
/// that value to this index, and the smaller values before it.
double atRank(std::vector<double>& values, std::size_t rank) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

double medianOf(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t half = values.size() / 2;
  const double upper = atRank(values, half);
  return values.size() % 2 ? upper : 0.5 * (atRank(values, half - 1) + upper);
}

double quantileOf(std::vector<double> values, double p) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::ceil(p * static_cast<double>(values.size()));
  return atRank(values, static_cast<std::size_t>(std::max(rank, 1.0)) - 1);
}

}  // namespace corridor
