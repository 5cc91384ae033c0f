#pragma once

#include <Eigen/Geometry>

#include "collision/core/transform.h"

namespace corridor {

/// A placement of a rigid body: position of its reference point and orientation. Any non-zero finite quaternion; motions
/// normalise it in real arithmetic, so the stored doubles need not have norm 1.
struct RigidPose {
  Vec3 p = Vec3::Zero();
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

/// How far a real motion may stray from the nominal one and still be covered by its proof: a displacement of each
/// coordinate of the position by at most `position` (metres) and a rotation by at most `rotation` (radians).
struct Tube {
  double position = 0;
  double rotation = 0;
};

}  // namespace corridor
