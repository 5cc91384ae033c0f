#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

/// Conversions of URDF's roll, pitch and yaw: rotations about the fixed axes x (roll), then y
/// (pitch), then z (yaw), in radians. Results are computed in long double and rounded once. An
/// angle that is the double nearest to a multiple of 90 degrees is taken for that multiple, with
/// exact sine and cosine.
namespace corridor {

Eigen::Quaterniond quaternionFromRpy(const Vec3& rpy);
Mat3 matrixFromRpy(const Vec3& rpy);

}  // namespace corridor
