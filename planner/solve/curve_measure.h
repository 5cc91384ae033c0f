#pragma once

#include <vector>

#include "planner/model/settings.h"
#include "planner/robot/configuration_space.h"
#include "planner/robot/curve.h"

namespace corridor {

/// A piece, as CurveRuler measures it, at points that divide it into parts of equal parameter.
/// Numbers are divided by their scales (CurveRuler), and lengths are Euclidean; s is the length
/// along the curve. One column for each point.
struct MeasuredPiece {
  /// For each number, how fast ds/dt may grow at (ds/dt)² = x: by less than gains − slopes·x; and
  /// how fast it may shrink: by less than gains + slopes·x. 1/s, and 1/s for each unit of x.
  Eigen::MatrixXd gains, slopes;
  Eigen::VectorXd lengths;  ///< of the part around the point, s; 0: the point is not used
  Eigen::VectorXd fastest;  ///< the largest (ds/dt)² at a constant speed
  double time = 0;          ///< least time if speed along the piece is gained and lost at once, s
  double length = 0;        ///< s
  double bend = 0;          ///< ∫ κ² ds, with the curvature κ; 1/s
};

/// What smoothing makes small.
struct CurveMeasure {
  double time = 0;    ///< estimate of the least time from rest to rest, s
  double length = 0;  ///< s
  double bend = 0;    ///< ∫ κ² ds, 1/s

  /// Returns the value that a goal makes small:
  /// - `acceleration`: length³·bend. It is proportional to the mean square of the acceleration if
  ///   the curve is passed through at constant speed in a fixed time.
  /// - `length`, and otherwise the time.
  double valueFor(Smoothing goal) const;
};

/// Measures curves, with the limits of the numbers as their scales, so that radians and metres
/// compare. The scale of a number is its largest velocity; without one, the velocity after 1 s of
/// its largest acceleration; without both, 1. Rotations are left out.
class CurveRuler {
 public:
  /// @param velocity, acceleration for each number, > 0; rad/s, m/s and so on. Infinity: no limit.
  /// Empty: all are 1.
  CurveRuler(const ConfigurationSpace& space, Configuration velocity, Configuration acceleration);

  /// Returns the time in which the fastest number passes through a difference at the velocity that
  /// is its scale.
  double timeOf(const Configuration& difference) const;

  /// Measures a piece, by the midpoint rule with twelve points.
  MeasuredPiece of(const CurvePiece& piece) const;

  /// Measures a curve of pieces, in this order. The time is that of a forward and a backward pass
  /// over the samples, in which the acceleration along the curve is what the curvature leaves of
  /// the limits: an estimate of the law of time_law.h, without its backtracking.
  /// A robot stops between two pieces whose tangents differ by more than 10^-6. For the bend, it
  /// turns there on an arc of 10^-3 of the length.
  CurveMeasure along(const std::vector<const MeasuredPiece*>& pieces,
                     const std::vector<double>& angles) const;

  /// Returns the angle between two tangents, in the scales of the numbers; 0 if it is below 10^-6.
  double angleBetween(const Configuration& first, const Configuration& second) const;

 private:
  /// The Bernstein polynomials of a degree at the points, one column for each point.
  using Basis = Eigen::MatrixXd;

  // 0 for rotations:
  Configuration weight_;      // 1/scale
  Configuration seconds_;     // scale/acceleration
  Configuration fastest_;     // the largest velocity over the scale, squared; infinity: no limit
  std::vector<Basis> bases_;  // by degree
};

}  // namespace corridor
