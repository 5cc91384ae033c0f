#pragma once

#include <Eigen/Core>

#include "collision/core/floating_point.h"

namespace corridor {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// The affine map x ↦ m·x + t. Named X_AB if it maps coordinates of frame B to frame A.
///
/// The twelve doubles *are* the map: queries use precisely these numbers, in real arithmetic,
/// whether or not m is exactly a rotation. (Only 24 matrices of doubles are exact rotations: the
/// signed permutations with determinant 1.) Lengths in metres.
///
/// The functions spell out their sums, in the order in which Eigen 3.4 adds them with SSE2: every
/// source includes this header, and Eigen's templates would take seconds to compile in each.
struct Transform {
  Mat3 m = Mat3::Identity();
  Vec3 t = Vec3::Zero();

  /// Returns the image of a point, rounded. `predicates/` works with the exact image.
  Vec3 operator*(const Vec3& p) const {
    return {m(0, 0) * p[0] + m(0, 1) * p[1] + m(0, 2) * p[2] + t[0],
            m(1, 0) * p[0] + m(1, 1) * p[1] + m(1, 2) * p[2] + t[1],
            m(2, 0) * p[0] + (m(2, 1) * p[1] + m(2, 2) * p[2]) + t[2]};
  }
  /// Returns the composition, rounded.
  Transform operator*(const Transform& other) const {
    Transform result;
    result.t = *this * other.t;
    for (int j = 0; j < 3; ++j) {
      const double x = other.m(0, j), y = other.m(1, j), z = other.m(2, j);
      result.m(0, j) = m(0, 0) * x + m(0, 1) * y + m(0, 2) * z;
      result.m(1, j) = m(1, 0) * x + m(1, 1) * y + m(1, 2) * z;
      result.m(2, j) = m(2, 0) * x + (m(2, 1) * y + m(2, 2) * z);
    }
    return result;
  }

  bool isFinite() const;
  bool operator==(const Transform& other) const {
    for (int i = 0; i < 9; ++i)
      if (m.data()[i] != other.m.data()[i]) return false;
    return t[0] == other.t[0] && t[1] == other.t[1] && t[2] == other.t[2];
  }
};

/// Returns the inverse of a rigid map, computed with the transpose of `X.m` in place of its
/// inverse. The result differs from the real inverse by rounding errors, and by the error that the
/// difference of `X.m` from a rotation causes.
Transform rigidInverse(const Transform& X);

}  // namespace corridor
