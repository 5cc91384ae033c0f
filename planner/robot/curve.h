#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "planner/robot/configuration_space.h"

namespace corridor {

/// A piece of a curve in a configuration space, for a parameter τ in [0, 1]. The curve is defined
/// in real arithmetic on the stored doubles:
/// - A coordinate of kind `line` or `circle` is the polynomial Σ_i B_i(τ)·coefficients(row, i),
///   where B_i are the Bernstein polynomials of the piece's degree. The coefficients of a circle
///   are taken literally: the angle is this polynomial even where another way round would be
///   shorter, and it may leave [−π, π].
/// - A coordinate of kind `rotation` is the slerp from the quaternion in the first column to that
///   in the last column, normalised in real arithmetic, along the shorter arc and at a constant
///   rate. The columns between these two are not used.
/// A joint that mimics another joint has the value multiplier·q + offset, where q is the literal
/// value of the other joint. So the mimicking joint never jumps.
///
/// The struct is plain data. The checker and the independent verifier both read it.
struct CurvePiece {
  static constexpr int kLargestDegree = 9;

  /// One row for each number of a Configuration, and one column for each Bernstein coefficient. The
  /// number of columns is the degree + 1, from 2 to kLargestDegree + 1. Metres, radians;
  /// quaternions as (x, y, z, w).
  Eigen::MatrixXd coefficients;
  /// For each number, an upper bound (≥ 0) of the deviation of the true curve from this piece's
  /// curve, such as the rounding of a conversion. Proofs add this bound to the tube. For a
  /// rotation, the bound is an angle, and is stored at the first of its four numbers. Metres,
  /// radians.
  Configuration error;

  int degree() const { return static_cast<int>(coefficients.cols()) - 1; }
};

/// Returns the configuration at τ in [0, 1], computed in double. The angles of circles are not
/// brought into [−π, π].
Configuration configurationAt(const ConfigurationSpace& space, const CurvePiece& piece, double tau);

/// A curve over time: pieces[k] covers the times [knots[k], knots[k + 1]], with
/// τ = (time − knots[k]) / (knots[k + 1] − knots[k]) in real arithmetic.
struct Curve {
  std::vector<double> knots;  ///< seconds, strictly ascending; one more knot than pieces
  std::vector<CurvePiece> pieces;
};

}  // namespace corridor
