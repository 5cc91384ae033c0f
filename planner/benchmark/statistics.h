#pragma once

#include <cstddef>
#include <vector>

/// Confidence intervals for reports.
namespace corridor {

/// A confidence interval for an unknown value. With probability `kConfidence`, the interval
/// contains the value: at least so for `medianInterval`, approximately for `shareInterval`.
struct Interval {
  double from = 0, to = 0;
};
constexpr double kConfidence = 0.95;

/// Returns an interval for the median of the distribution that the values are drawn from; any
/// continuous distribution is allowed. The ends of the interval are two of the values. By the
/// binomial distribution, the median is below the interval with a probability of at most (1 −
/// kConfidence)/2, and above the interval with at most the same probability. The interval is
/// infinite if there are fewer than six values.
Interval medianInterval(std::vector<double> values);

/// Returns Wilson's score interval (1927) for the probability of an event that was observed in
/// `hits` of `trials` trials. Returns [0, 1] if there are no trials.
Interval shareInterval(std::size_t hits, std::size_t trials);

}  // namespace corridor
