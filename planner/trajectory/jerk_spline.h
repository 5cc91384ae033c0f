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

/// y(σ) = σ̇² along a run, as a spline of degree 2, and the search for the spline with the shortest
/// time that keeps the limits (jerk_law.h has the method). The limits hold at both ends and in the
/// middle of each interval between knots.
class JerkSpline {
 public:
  JerkSpline(const PathView& view, const PathRun& run, const JointLimits& limits,
             const KinematicTree& tree);

  /// Sets knots, and a first spline, from states of a law. @pre s ascends, and one state is at each
  /// end of a piece.
  void set(const std::vector<PathState>& states);
  /// Slows the law down as a whole until it is strictly within the limits.
  /// @returns false if no factor is small enough.
  bool slowToLimits();
  /// Shortens the time: minimises weight·(number of knots)·time/(present duration) + barrier. @pre
  /// the law is strictly within the limits.
  /// @param weight the larger it is, the closer to the optimum the time gets. The time exceeds the
  /// optimum by a share of about (terms of the barrier per knot) / weight.
  void shorten(double weight);
  /// Halves intervals of three kinds: those that exceed a limit at one or three fourths of their
  /// width; those in which y varies much; and those that take longer than `shortest` seconds, if
  /// the jerk varies much in them or jumps at their ends. The law may exceed limits in the middle
  /// of the new intervals. @returns whether any interval was halved.
  bool refine(double shortest);

  double duration() const { return durationOf(c_); }
  /// Returns the law at the knots.
  std::vector<PathState> states() const;
  /// Returns, for each interval, the part of the run that it is in.
  const std::vector<std::size_t>& parts() const { return parts_; }
  /// Returns s at the start of each part, and at the end.
  const std::vector<double>& begins() const { return begins_; }

 private:
  /// Derivatives of a number by σ, as shares of its limits: q̈ = second·y + first·u, and
  /// q⃛ = (third·y + secondJerk·u + firstJerk·w)·√y.
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
  /// Computes the rows of a place in an interval. @returns the largest y that velocities allow.
  double rowsAt(std::size_t interval, double t, Row* rows) const;
  void setRows();
  /// The factor by which time must be stretched so that all limits hold: the square root of the
  /// factor by which an acceleration is exceeded, and the cube root for a jerk.
  double excessAt(std::size_t interval, double t) const;
  /// The largest difference of a jerk between two places, as a share of its limit.
  double jerkChange(std::size_t a, std::size_t b) const;
  /// −Σ log of the gaps to the limits; infinity if a limit is reached.
  double barrier(const std::vector<double>& c) const;
  Local barrierAt(std::size_t place, const Value& value) const;
  /// Makes one step of Newton's method. @returns whether it is worthwhile to make another.
  bool improve(double weight);

  const PathView& view_;
  const PathRun& run_;
  const JointLimits& limits_;
  const KinematicTree& tree_;
  const std::vector<LimitedNumbers> numbers_;
  std::size_t rowCount_ = 0;    // rows at a place
  std::vector<double> begins_;  // s at the start of each part, and at the end
  Onset map_;
  std::vector<double> knots_;                 // σ
  std::vector<std::size_t> parts_;            // of each interval
  std::vector<std::array<double, 2>> blend_;  // of each interval: see bernstein()
  std::vector<double> c_;                     // coefficients of the spline: intervals + 2
  std::vector<Row> rows_;                     // three places in each interval
  std::vector<double> maxY_;                  // the largest y that velocities allow, at each place
};

}  // namespace corridor
