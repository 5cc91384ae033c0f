#pragma once

#include <array>

#include "planner/trajectory/limits_proof.h"

namespace corridor {

/// Bernstein coefficients on [0, 1], and a bound of the rounding error of each.
struct BoundedPolynomial {
  int degree = 0;
  std::array<double, 6> c{}, error{};
};

/// The curve of one number between two rows.
struct RowPolynomials {
  /// The position is near + rise(τ), where `near` is the position of the first row for the first
  /// half of the coefficients and that of the second row for the others. This keeps the rounding
  /// small against the motion instead of the position.
  BoundedPolynomial rise;
  std::array<double, 6> near{};
  BoundedPolynomial velocity, acceleration, jerk;  ///< derivatives by time
};

/// Returns the curve of number `number` between two rows. Derivatives to which no limit applies are
/// the constant 0: the acceleration for degree 1, and the jerk for degrees 1 and 3.
/// @param degree 1, 3 or 5.
RowPolynomials rowPolynomials(const TimedRow& from, const TimedRow& to, int degree,
                              Eigen::Index number);

}  // namespace corridor
