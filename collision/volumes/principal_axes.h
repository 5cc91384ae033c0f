#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// Returns the eigenvectors of a covariance as columns, the eigenvector of the largest eigenvalue
/// first: right-handed, orthonormal to 2^-40, and accurate enough for the axes of a box. Two
/// eigenvalues count as equal if they differ by at most some 2^-19 of their sum. Returns the
/// identity if all are equal (as for a sphere or a cube), 0, or not finite.
Mat3 principalAxes(const Mat3& covariance);

}  // namespace corridor
