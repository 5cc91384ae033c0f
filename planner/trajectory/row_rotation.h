#pragma once

#include <Eigen/Core>

#include "planner/trajectory/limits_proof.h"

namespace corridor {

/// The rotation of a floating joint between two rows: a slerp of constant angular velocity, in real
/// arithmetic on the stored quaternions (curve.h).
struct RowRotation {
  /// The angular velocity, rad/s, in the coordinates of the frame before the joint. Computed in
  /// long double.
  Eigen::Matrix<long double, 3, 1> rate = Eigen::Matrix<long double, 3, 1>::Zero();
  /// An upper bound of the length of `rate` minus the true angular velocity: 2^-57 rad divided by
  /// the duration, or 0 if the joint rests (row_rotation.cpp).
  long double error = 0;
  /// Whether the rows are half a turn apart, within 1e-9 rad, or a quaternion is 0. Then no curve
  /// is defined. (If they are half a turn apart, `error` still bounds the error of the rate's
  /// length.)
  bool ambiguous = false;

  long double length() const { return rate.norm() + error; }  ///< an upper bound, up to 2^-62 of it
};

/// Returns the rotation between two rows. The results are valid if the processor's floating-point
/// mode is as PROMISES.md, promise 7, assumes.
/// @param first the index of the rotation's first number in a Configuration.
RowRotation rowRotation(const TimedRow& from, const TimedRow& to, Eigen::Index first);

}  // namespace corridor
