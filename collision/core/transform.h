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
struct Transform {
  Mat3 m = Mat3::Identity();
  Vec3 t = Vec3::Zero();

  /// Returns the image of a point, rounded. `predicates/` works with the exact image.
  Vec3 operator*(const Vec3& p) const { return m * p + t; }
  /// Returns the composition, rounded.
  Transform operator*(const Transform& other) const { return {m * other.m, m * other.t + t}; }

  bool isFinite() const { return m.allFinite() && t.allFinite(); }
  bool operator==(const Transform& other) const { return m == other.m && t == other.t; }
};

/// Returns the inverse of a rigid map, computed with the transpose of `X.m` in place of its
/// inverse. The result differs from the real inverse by rounding errors, and by the error that the
/// difference of `X.m` from a rotation causes.
inline Transform rigidInverse(const Transform& X) {
  return {X.m.transpose(), -(X.m.transpose() * X.t)};
}

}  // namespace corridor
