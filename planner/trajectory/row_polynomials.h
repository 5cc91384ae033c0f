#pragma once

#include <array>

#include "planner/trajectory/limits_proof.h"

namespace corridor {

/// Bernstein coefficients of a polynomial on [0, 1], and a bound of the rounding error of each
/// coefficient.
struct BoundedPolynomial {
  int degree = 0;
  std::array<double, 6> c{}, error{};
};

/// The curve of one component of a configuration between two rows, for τ from 0 to 1.
struct RowPolynomials {
  /// The Bernstein coefficients of the position are near[i] + rise.c[i]. `near` is the position of
  /// the first row in the first half of the coefficients, and the position of the second row in the
  /// others. So the rounding errors of `rise` are small compared with the motion, not only with the
  /// position.
  BoundedPolynomial rise;
  std::array<double, 6> near{};
  BoundedPolynomial velocity, acceleration, jerk;  ///< derivatives by time
};

/// Returns the curve of the component with the index `number` between two rows. Derivatives to
/// which no limit applies are the constant 0: the acceleration for degree 1, and the jerk for
/// degrees 1 and 3.
/// @param degree 1, 3 or 5.
RowPolynomials rowPolynomials(const TimedRow& from, const TimedRow& to, int degree,
                              Eigen::Index number);

}  // namespace corridor
