#pragma once

#include <cstddef>
#include <vector>

/// What a report says of many runs.
namespace corridor {

/// The middle one, or the mean of the two in the middle; of a share p of the values none is larger
/// than the quantile (the nearest rank: of ten values, 0.95 is the largest). NaN of no values.
double medianOf(std::vector<double> values);
double quantileOf(std::vector<double> values, double p);

/// From … to, with which a true value is held, as often as `kConfidence` says.
struct Interval {
  double from = 0, to = 0;
};
constexpr double kConfidence = 0.95;

/// Of the median of what the values are drawn from, whatever that is: between two of the values,
/// whose ranks are so that the binomial distribution gives no more than (1 − kConfidence)/2 to
/// either side. Infinite where there are too few values (fewer than six).
Interval medianInterval(std::vector<double> values);

/// Of a share, of which `hits` of `of` were seen: Wilson's score interval (1927). [0, 1] of none.
Interval shareInterval(std::size_t hits, std::size_t of);

}  // namespace corridor
