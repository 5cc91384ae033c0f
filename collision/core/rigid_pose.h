#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

namespace corridor {

/// A placement of a rigid body: the position of its reference point (metres) and its orientation.
/// The quaternion may be any finite quaternion except zero. Motions normalise it in real
/// arithmetic, so the stored doubles need not have norm 1.
struct RigidPose {
  Vec3 p = Vec3::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// Returns the rotation matrix of a quaternion, rounded. It is exact for the 24 rotations that map
/// coordinate axes to coordinate axes, such as quarter turns, under one condition: the stored
/// coefficients are 0 where the real ones are 0, and all others have the same magnitude. (Other
/// formulas, with entries such as 1 − 2(y² + z²), have a rounding error of 2^-53 where these
/// rotations have a 0, so that surfaces in contact would come apart.)
/// @pre the norm of q is from 2^-200 to 2^200. It need not be 1.
template <class Real>
Eigen::Matrix<Real, 3, 3> rotationMatrix(const Eigen::Quaternion<Real>& q) {
  const Real ww = q.w() * q.w(), xx = q.x() * q.x(), yy = q.y() * q.y(), zz = q.z() * q.z();
  const Real xy = q.x() * q.y(), xz = q.x() * q.z(), yz = q.y() * q.z();
  const Real wx = q.w() * q.x(), wy = q.w() * q.y(), wz = q.w() * q.z();
  const Real n = ww + xx + yy + zz;
  Eigen::Matrix<Real, 3, 3> m;
  m(0, 0) = (ww + xx - yy - zz) / n;
  m(0, 1) = 2 * (xy - wz) / n;
  m(0, 2) = 2 * (xz + wy) / n;
  m(1, 0) = 2 * (xy + wz) / n;
  m(1, 1) = (ww - xx + yy - zz) / n;
  m(1, 2) = 2 * (yz - wx) / n;
  m(2, 0) = 2 * (xz - wy) / n;
  m(2, 1) = 2 * (yz + wx) / n;
  m(2, 2) = (ww - xx - yy + zz) / n;
  return m;
}

}  // namespace corridor
