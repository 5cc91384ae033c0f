#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

/// Conversions of roll, pitch and yaw, as in URDF: rotations about the fixed axes x (roll), then y
/// (pitch), then z (yaw). Results are computed in long double and rounded once. Multiples of 90
/// degrees have exact sines and cosines. An angle in radians counts as such a multiple if it is the
/// double nearest to it, up to 1024 turns.
namespace corridor {

Eigen::Quaterniond quaternionFromRpy(const Vec3& radians);
Mat3 matrixFromRpy(const Vec3& radians);

Eigen::Quaterniond quaternionFromRpyDegrees(const Vec3& degrees);
Mat3 matrixFromRpyDegrees(const Vec3& degrees);

}  // namespace corridor
