#pragma once

#include <Eigen/Core>

#include "collision/core/floating_point.h"

namespace corridor {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;

/// The affine map x ↦ m·x + t, named X_AB where it takes coordinates of frame B to frame A.
///
/// The twelve doubles *are* the map: queries answer for them in real arithmetic, whether or not m
/// is a rotation to the last bit (no matrix of doubles is, but the 24 signed permutations). Lengths
/// in metres.
struct Transform {
  Mat3 m = Mat3::Identity();
  Vec3 t = Vec3::Zero();

  /// Rounded; who needs the exact point uses predicates/.
  Vec3 operator*(const Vec3& p) const { return m * p + t; }
  /// Rounded.
  Transform operator*(const Transform& other) const { return {m * other.m, m * other.t + t}; }

  bool isFinite() const { return m.allFinite() && t.allFinite(); }
  bool operator==(const Transform& other) const { return m == other.m && t == other.t; }
};

/// The inverse of a rigid map, up to rounding and to the defect of `X.m`: R ↦ Rᵀ.
inline Transform rigidInverse(const Transform& X) {
  return {X.m.transpose(), -(X.m.transpose() * X.t)};
}

}  // namespace corridor
