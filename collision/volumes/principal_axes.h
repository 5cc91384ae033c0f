#pragma once

#include "collision/core/transform.h"

namespace corridor {

/// Eigenvectors of a covariance, as columns, of the largest eigenvalue first: right-handed,
/// orthonormal to 2^-40, and as good as axes of a box need be. Eigenvalues that differ by less than
/// 2^-20 of them count as equal; the identity where all are (a ball's, a cube's), 0 or not finite.
Mat3 principalAxes(const Mat3& covariance);

}  // namespace corridor
