#pragma once

#include <vector>

/// Medians and quantiles of measurements, in linear time.
namespace corridor {

/// Returns the middle value, or the mean of the two values in the middle; NaN if there are no
/// values.
double medianOf(std::vector<double> values);

/// Returns the smallest value v such that at least a fraction p of the values are ≤ v (the
/// nearest-rank method: for ten values, p = 0.95 gives the largest). Returns NaN if there are no
/// values. @pre 0 ≤ p ≤ 1.
double quantileOf(std::vector<double> values, double p);

}  // namespace corridor
