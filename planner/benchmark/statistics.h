#pragma once

#include <cstddef>
#include <vector>

/// Medians, quantiles and confidence intervals for reports.
namespace corridor {

/// `medianOf` returns the middle value, or the mean of the two in the middle. `quantileOf` returns
/// the smallest value v such that at least a share p of the values are ≤ v (the nearest rank: for
/// ten values, 0.95 gives the largest). NaN without values.
double medianOf(std::vector<double> values);
double quantileOf(std::vector<double> values, double p);

/// A confidence interval: holds the true value with probability `kConfidence`.
struct Interval {
  double from = 0, to = 0;
};
constexpr double kConfidence = 0.95;

/// Returns an interval for the median of the distribution that the values are drawn from, whatever
/// it is. The interval is between two of the values, with ranks so that the binomial distribution
/// gives each side a probability of at most (1 − kConfidence)/2. Infinite if there are too few
/// values (fewer than six).
Interval medianInterval(std::vector<double> values);

/// Returns Wilson's score interval (1927) for the probability of an event that was observed in
/// `hits` of `of` trials. Returns [0, 1] if `of` is 0.
Interval shareInterval(std::size_t hits, std::size_t of);

}  // namespace corridor
