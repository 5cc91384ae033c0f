#include "planner/trajectory/reachability.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace corridor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Interval {
  double lower = 0, upper = 0;
};

/// A line in the plane (x, u), which bounds the allowed pairs: u = value − slope·x.
struct Line {
  double value = 0, slope = 0;
  double at(double x) const { return value - slope * x; }
};

/// The pairs (x, u) that the limits of one interval of the grid allow: x is in [0, cap()]. Each
/// line of `lines_` gives an upper bound, u ≤ value − slope·x, and a lower bound, u ≥ −value −
/// slope·x.
class Cell {
 public:
  /// Sets the limits at both ends of interval i.
  void set(const LimitGrid& grid, std::size_t i) {
    lines_.clear();
    width_ = grid.s[i + 1] - grid.s[i];
    cap_ = grid.xMax[i];
    for (std::size_t k = 0; k < grid.bands; ++k) {
      const std::size_t left = i * grid.bands + k, right = left + grid.bands;
      add(grid.a[left], grid.b[left]);
      add(grid.a[right] + 2 * width_ * grid.b[right], grid.b[right]);  // x at the right end: x+2Δu
    }
  }
  double cap() const { return cap_; }
  double width() const { return width_; }

  /// Sets `low` to the largest lower bound of u at x, and `high` to the smallest upper bound. These
  /// bounds also keep the x at the right end of the interval in `next`.
  void bounds(double x, const Interval& next, Line& low, Line& high) const {
    const double half = 0.5 / width_;  // x at the right end: lower ≤ x + 2Δu ≤ upper
    high = {next.upper * half, half};
    low = {next.lower * half, half};
    double most = high.at(x), least = low.at(x);
    for (const Line& line : lines_) {
      const double middle = -line.slope * x;
      if (middle + line.value < most) {
        most = middle + line.value;
        high = line;
      }
      if (middle - line.value > least) {
        least = middle - line.value;
        low = {-line.value, line.slope};
      }
    }
  }

  /// Returns the interval of the x from which `next` can be reached; lower > upper if there is no
  /// such x. The set of pairs (x, u) is convex, so the width of the range of u is a concave
  /// function of x. Newton's method, from outside of the interval, never steps over a root of this
  /// function. It ends at a root, since the function is piecewise linear.
  Interval reachableFrom(const Interval& next) const {
    double top = cap_;
    if (!std::isfinite(top)) {
      // For any line, u ≥ −value − slope·x and x + 2Δu ≤ upper give x·(1 − 2Δ·slope) ≤ upper +
      // 2Δ·value. The smallest of these bounds of x is used. The line of a component that hardly
      // moves has a very large value. If the search for the root began at the bound from such a
      // line, rounding would hide the root.
      for (const Line& line : lines_)
        if (2 * width_ * std::abs(line.slope) <= 0.5)
          top = std::min(top, 2 * (next.upper + 2 * width_ * line.value));
      if (!std::isfinite(top)) {
        top = 4 * next.upper;
        for (const Line& line : lines_) top = std::max(top, 4 * line.value * width_);
      }
      if (!std::isfinite(top)) return {0, kInfinity};
    }
    const double upper = root(top, next, true);
    if (!(upper >= 0)) return {1, 0};
    const double lower = root(0, next, false);
    return lower <= upper ? Interval{lower, upper} : Interval{upper, upper};
  }

 private:
  void add(double a, double b) {
    const double size = std::abs(a), slope = a < 0 ? -b : b;
    // A band with a negligible coefficient of u counts as a bound of x alone. Within the interval,
    // |u| is at most x/(2·width), so the term with u is then at most 1e-9 of the limit.
    if (size <= 1e-9 * (2 * width_ * std::abs(b)) || size < 1e-200)
      cap_ = std::min(cap_, std::abs(b) > 0 ? 1 / std::abs(b) : kInfinity);
    else
      lines_.push_back({1 / size, slope / size});
  }

  /// Returns the first x at which some u is allowed, from `x` downwards or upwards. Returns NaN if
  /// there is no such x.
  double root(double x, const Interval& next, bool downwards) const {
    // x = 0 with u = 0 is always allowed if the next x may be 0.
    const double none = downwards && next.lower == 0 ? 0 : NAN;
    for (std::size_t step = 0; step < 4 * lines_.size() + 8; ++step) {
      Line low, high;
      bounds(x, next, low, high);
      const double gap = high.at(x) - low.at(x);
      if (gap >= 0) return x;
      const double slope = low.slope - high.slope;  // the slope of the gap
      if (downwards ? slope >= 0 : slope <= 0) return none;
      const double to = x - gap / slope;
      if (to < 0) return none;
      // Rounding of the lines keeps the gap from becoming exactly 0.
      if (std::abs(to - x) <= 0x1p-44 * x) return to;
      x = to;
    }
    return x;
  }

  std::vector<Line> lines_;
  double width_ = 0, cap_ = 0;
};

}  // namespace

Profile fastestProfile(const LimitGrid& grid, double start, double end) {
  const std::size_t n = grid.size();
  Profile profile;
  profile.x.assign(n, 0);
  profile.u.assign(n - 1, 0);
  const auto fail = [&](Profile::Failure failure, std::size_t node, const Interval& set) {
    profile.failure = failure;
    profile.node = node;
    profile.lower = set.lower;
    profile.upper = set.upper;
    return profile;
  };
  std::vector<Interval> sets(n);
  const double last = grid.xMax[n - 1];
  sets[n - 1] = std::isfinite(end) ? Interval{end, end} : Interval{0, last};
  // A given rate may be exactly at the limit, so its rounding is allowed for.
  if (std::isfinite(end) && end > last * (1 + 0x1p-40))
    return fail(Profile::Failure::end, n - 1, {0, last});
  Cell cell;
  for (std::size_t i = n - 1; i-- > 0;) {
    if (grid.s[i + 1] == grid.s[i]) {
      sets[i] = {sets[i + 1].lower, std::min(sets[i + 1].upper, grid.xMax[i])};
    } else {
      cell.set(grid, i);
      sets[i] = cell.reachableFrom(sets[i + 1]);
    }
    if (!(sets[i].lower <= sets[i].upper)) return fail(Profile::Failure::end, i, sets[i + 1]);
  }
  double x = std::isfinite(start) ? start : sets[0].upper;
  if (!(x >= sets[0].lower * (1 - 0x1p-40) && x <= sets[0].upper * (1 + 0x1p-40)))
    return fail(Profile::Failure::start, 0, sets[0]);
  profile.x[0] = x;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (grid.s[i + 1] > grid.s[i]) {
      cell.set(grid, i);
      Line low, high;
      cell.bounds(x, sets[i + 1], low, high);
      const double u = std::max(high.at(x), low.at(x));
      const double to = std::clamp(x + 2 * cell.width() * u, sets[i + 1].lower, sets[i + 1].upper);
      profile.u[i] = (to - x) / (2 * cell.width());
      if (!(x + to > 0)) return fail(Profile::Failure::stuck, i, sets[i + 1]);
      x = to;
    } else {
      x = std::clamp(x, sets[i + 1].lower, sets[i + 1].upper);
    }
    profile.x[i + 1] = x;
  }
  return profile;
}

}  // namespace corridor
