#pragma once

#include <vector>

#include "planner/model/settings.h"
#include "planner/robot/configuration_space.h"
#include "planner/robot/curve.h"

namespace corridor {

/// The measures of a piece, by CurveRuler. The piece is divided into parts of equal parameter, with
/// a point in the middle of each. The matrices have one column, and the vectors one entry, for each
/// point.
///
/// The numbers of a configuration are divided by their scales, which are velocities (CurveRuler).
/// Therefore Euclidean lengths are in seconds. Let s be the length along the curve: ds/dt has no
/// unit.
struct MeasuredPiece {
  /// For each number, the bounds of d²s/dt² that its largest acceleration allows, in 1/s, where
  /// x = (ds/dt)²: ds/dt grows by at most gains − slopes·x, and shrinks by at most gains +
  /// slopes·x.
  Eigen::MatrixXd gains, slopes;
  Eigen::VectorXd lengths;  ///< of the part around each point, seconds; 0: not used
  Eigen::VectorXd fastest;  ///< largest (ds/dt)² that the limits allow at a constant speed
  double time = 0;          ///< least time if the speed may change in jumps, seconds
  double length = 0;        ///< seconds
  double bend = 0;          ///< ∫ κ² ds, with the curvature κ; 1/seconds
};

/// Measures of a whole curve. Smoothing reduces one of them, or a product of them (`valueFor`).
struct CurveMeasure {
  double time = 0;    ///< estimate of the least time from rest to rest, seconds
  double length = 0;  ///< seconds (MeasuredPiece)
  double bend = 0;    ///< ∫ κ² ds, 1/seconds

  /// Returns the measure that smoothing with the setting `goal` reduces:
  /// - `acceleration`: length³·bend. This is proportional to the mean square of the acceleration if
  ///   the robot passes along the curve at constant speed in a fixed time.
  /// - `length`: the length.
  /// - all other settings: the time.
  double valueFor(Smoothing goal) const;
};

/// Measures curves. Each number of a configuration is divided by a scale, so that radians and
/// metres compare. The scale is the number's largest velocity; without a limit of velocity, the
/// velocity after 1 s of its largest acceleration; without both limits, 1. Rotations are left out.
class CurveRuler {
 public:
  /// @param velocity, acceleration for each number, > 0; rad/s, m/s and so on. Infinity: no limit.
  /// Empty: all are 1.
  CurveRuler(const ConfigurationSpace& space, Configuration velocity, Configuration acceleration);

  /// Returns the time, seconds, that a difference takes if every number moves at the velocity that
  /// is its scale: the largest |difference| / scale of a number.
  double timeOf(const Configuration& difference) const;

  /// Measures a piece, by the midpoint rule with twelve points.
  MeasuredPiece of(const CurvePiece& piece) const;

  /// Measures a curve of pieces, in this order. A forward and a backward pass over the points give
  /// the time. In these passes, the acceleration along the curve is limited by the part of the
  /// limits that the curvature does not use. The result is an estimate of the time of the law of
  /// time_law.h, without that law's controllable sets.
  /// @param angles between each piece and the next, radians (angleBetween()). Where an angle is not
  /// 0, the robot stops. `bend` is computed as if the robot turned there on an arc of 10^-3 of the
  /// curve's length.
  CurveMeasure along(const std::vector<const MeasuredPiece*>& pieces,
                     const std::vector<double>& angles) const;

  /// Returns the angle between two tangents, whose numbers are divided by their scales; radians.
  /// The result is 0 for an angle of up to 10^-6.
  double angleBetween(const Configuration& first, const Configuration& second) const;

 private:
  /// The Bernstein polynomials of a degree at the points, one column for each point.
  using Basis = Eigen::MatrixXd;

  Configuration weight_;      // 1/scale; 0 for rotations
  Configuration seconds_;     // scale/acceleration; 0 for rotations
  Configuration fastest_;     // (largest velocity / scale)²; infinity: no limit of velocity
  std::vector<Basis> bases_;  // one for each degree
};

}  // namespace corridor
