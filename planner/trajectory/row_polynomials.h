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
  BoundedPolynomial velocity, acceleration, jerk;  ///< by time
};

/// @param degree 1, 3 or 5. The derivatives that limits do not concern have degree 0 and value 0:
/// the acceleration of 1, the jerk of 1 and 3.
RowPolynomials rowPolynomials(const TimedRow& from, const TimedRow& to, int degree,
                              Eigen::Index number);

}  // namespace corridor
