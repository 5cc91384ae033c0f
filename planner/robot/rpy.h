#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

/// Rotations as URDF writes them: about the fixed axes x (roll), then y (pitch), then z (yaw),
/// radians. Computed in long double and rounded once. An angle that is the double nearest to a
/// multiple of 90 degrees is taken for that multiple: its sine and cosine are exact.
namespace corridor {

Eigen::Quaterniond quaternionFromRpy(const Vec3& rpy);
Mat3 matrixFromRpy(const Vec3& rpy);

}  // namespace corridor
