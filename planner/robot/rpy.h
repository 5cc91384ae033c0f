#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

/// Conversions of roll, pitch and yaw, as in URDF: rotations about the fixed axes x (roll), then y
/// (pitch), then z (yaw). Results are computed in long double and rounded once. Multiples of 90
/// degrees have exact sines and cosines. In radians, the double nearest to such a multiple is taken
/// for it.
namespace corridor {

Eigen::Quaterniond quaternionFromRpy(const Vec3& radians);
Mat3 matrixFromRpy(const Vec3& radians);

Eigen::Quaterniond quaternionFromRpyDegrees(const Vec3& degrees);
Mat3 matrixFromRpyDegrees(const Vec3& degrees);

}  // namespace corridor
