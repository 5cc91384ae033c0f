#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

/// Conversions of roll, pitch and yaw, as in URDF: rotations about the fixed axes x (roll), then y
/// (pitch), then z (yaw). Results are computed in long double and rounded once. Multiples of 90
/// degrees have exact sines and cosines. An angle in radians of at most 1024 turns counts as such a
/// multiple if it is the double nearest to the multiple.
namespace corridor {

Eigen::Quaterniond quaternionFromRpy(const Vec3& radians);
Mat3 matrixFromRpy(const Vec3& radians);

Eigen::Quaterniond quaternionFromRpyDegrees(const Vec3& degrees);
Mat3 matrixFromRpyDegrees(const Vec3& degrees);

}  // namespace corridor
