#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

namespace corridor {

/// A placement of a rigid body: the position of its reference point (metres) and its orientation.
/// The quaternion may be any finite one except zero: motions normalise it in real arithmetic, so
/// that the stored doubles need not have norm 1.
struct RigidPose {
  Vec3 p = Vec3::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

}  // namespace corridor
