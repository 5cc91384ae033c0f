#pragma once

#include <array>
#include <vector>

#include "planner/trajectory/limit_bands.h"
#include "planner/trajectory/onset.h"
#include "planner/trajectory/path_runs.h"

namespace corridor {

/// A time law s(t) at one time: s and its first two derivatives.
struct PathState {
  double time = 0, s = 0, rate = 0, acceleration = 0;
};

/// The function y(σ) = σ̇² along a run, as a spline of degree 2, and the search for the spline with
/// the shortest time that keeps the limits. jerk_law.h describes the method, and defines σ, y, u
/// and w. The limits hold at both ends and in the middle of each interval between knots.
class JerkSpline {
 public:
  JerkSpline(const PathView& view, const PathRun& run, const JointLimits& limits,
             const KinematicTree& tree);

  /// Sets the knots, and a first spline, from states of a law. @pre The states' s ascend, and each
  /// end of a piece has a state.
  void set(const std::vector<PathState>& states);
  /// Slows the law down as a whole until it is strictly within the limits at the places where
  /// limits hold.
  /// @returns false if the law still exceeds a limit after the largest slowdown that is tried.
  bool slowToLimits();
  /// Makes the law faster: minimises weight·(number of knots)·time/(duration before the call) +
  /// barrier. @pre The law is strictly within the limits.
  /// @param weight with a larger weight, the time gets closer to the optimum. The time exceeds the
  /// optimum by about the fraction (terms of the barrier per knot) / weight.
  void shorten(double weight);
  /// Halves three kinds of intervals: intervals that exceed a limit at one or three fourths of
  /// their width; intervals in which y varies much; and intervals that take longer than `shortest`
  /// seconds, if the jerk varies much in them or jumps at one of their ends. The law may exceed
  /// limits in the middle of the new intervals. @returns whether any interval was halved.
  bool refine(double shortest);

  double duration() const { return durationOf(c_); }
  /// Returns the law at the knots.
  std::vector<PathState> states() const;
  /// Returns, for each interval, the index of the part of the run (PathRun) that contains it.
  const std::vector<std::size_t>& parts() const { return parts_; }
  /// Returns s at the start of each part of the run, and at the end of the run.
  const std::vector<double>& begins() const { return begins_; }

 private:
  /// The derivatives by σ of one component of a configuration. `first` and `second` are divided by
  /// the limit of acceleration; the others are divided by the limit of jerk. So, as ratios to these
  /// limits, q̈ = second·y + first·u, and q⃛ = (third·y + secondJerk·u + firstJerk·w)·√y.
  struct Row {
    double first = 0, second = 0, firstJerk = 0, secondJerk = 0, third = 0;
    double acceleration(double y, double u) const { return second * y + first * u; }
    double jerk(double y, double u, double w) const {
      return third * y + secondJerk * u + firstJerk * w;
    }
  };
  /// y, u = y′/2 and w = y″/2.
  struct Value {
    double y = 0, u = 0, w = 0;
  };
  /// A gradient, and the upper half of a Hessian, in (y, u, w).
  struct Local {
    std::array<double, 3> gradient{};
    std::array<double, 6> hessian{};  // yy, yu, yw, uu, uw, ww
    void addSquare(double factor, double y, double u, double w);
  };
  using Triple = std::array<double, 3>;

  Triple bernstein(const std::vector<double>& c, std::size_t interval) const;
  double widthOf(std::size_t interval) const { return knots_[interval + 1] - knots_[interval]; }
  static Value valueAt(const Triple& b, double width, double t);
  static double timeOf(const Triple& b, double width);
  double durationOf(const std::vector<double>& c) const;
  /// Computes the rows at the place t of an interval, where t is in [0, 1]: one row for each
  /// limited component. @returns the largest y that the limits of velocity and link speed allow
  /// there.
  double rowsAt(std::size_t interval, double t, Row* rows) const;
  void setRows();
  /// Returns the factor by which times must be multiplied so that all limits hold at the place t of
  /// an interval; below 1 if there is room. A ratio r of a value to its limit needs r for a
  /// velocity, √r for an acceleration, and the cube root of r for a jerk.
  double excessAt(std::size_t interval, double t) const;
  /// Returns the largest difference of a component's jerk between two places, divided by the limit
  /// of jerk.
  double jerkChange(std::size_t a, std::size_t b) const;
  /// Returns −Σ log(gap) over all limits at all places, where a gap is 1 minus the ratio of a
  /// squared value to its squared limit (for velocities: 1 − y/maxY). Returns infinity if a limit
  /// is reached.
  double barrier(const std::vector<double>& c) const;
  Local barrierAt(std::size_t place, const Value& value) const;
  /// Makes one step of Newton's method, if it is worthwhile. @returns whether a step was made.
  bool improve(double weight);

  const PathView& view_;
  const PathRun& run_;
  const JointLimits& limits_;
  const KinematicTree& tree_;
  const std::vector<LimitedNumbers> numbers_;
  std::size_t rowCount_ = 0;    // number of rows at each place
  std::vector<double> begins_;  // s at the start of each part, and at the end
  Onset map_;
  std::vector<double> knots_;                 // σ
  std::vector<std::size_t> parts_;            // for each interval: index into PathRun::parts
  std::vector<std::array<double, 2>> blend_;  // two weights for each interval: see bernstein()
  std::vector<double> c_;                     // coefficients of the spline: intervals + 2
  std::vector<Row> rows_;     // rowCount_ rows for each of the three places of each interval
  std::vector<double> maxY_;  // the largest y that speed limits allow, at each place
};

}  // namespace corridor
