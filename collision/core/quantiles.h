#pragma once

#include <vector>

/// Medians and quantiles of measurements, in linear time.
namespace corridor {

/// Returns the middle value, or the mean of the two values in the middle; NaN without values.
double medianOf(std::vector<double> values);

/// Returns the smallest value v such that at least a share p of the values are ≤ v (the nearest
/// rank: for ten values, 0.95 gives the largest); NaN without values. @pre 0 ≤ p ≤ 1.
double quantileOf(std::vector<double> values, double p);

}  // namespace corridor
